// SPDX-License-Identifier: BSD-3-Clause
// Optimizer: our back end on the engine's graph.
#pragma once

#include <Eigen/Geometry>
#include <map>
#include <set>

#include "engine_step.h"
#include "roomgraph/estimation/options.h"
#include "roomgraph/graphslam/constraints.h"
#include "roomgraph/graphslam/pose_network.h"
#include "semantic_annotations.h"

namespace roomgraph {

/// What keeps its own estimate of the nodes. After each new node the engine replaces all poses by those of a
/// spanning tree of the edges (Dijkstra), whatever its optimizer found.
class PoseKeeper {
 public:
  virtual ~PoseKeeper() = default;
  /// Puts the estimate into the graph again.
  virtual void restore() = 0;
  /// Solves to the end, with all edges.
  virtual void finish() = 0;
};

/// Robust least squares over the engine's graph. Edges within local_map_nodes of [backend] are movements, all others loop
/// closures, with a robust loss of their own (closure_robust_width). Solves when a closure
/// disagrees with the estimate, or else now and then; to the end in finish().
template <class GRAPH>
class CFactorGraphGSO : public mrpt::graphslam::optimizers::CGraphSlamOptimizer<GRAPH>, public PoseKeeper {
 public:
  using Edge = typename GRAPH::edges_map_t::value_type;

  explicit CFactorGraphGSO(const BackendOptions& options) : options_(options) {
    network_.planar = kPlanar<GRAPH>;
    this->initializeLoggers("CFactorGraphGSO");
  }

  void loadParams(const std::string& file) override {
    const mrpt::config::CConfigFile ini(file);
    this->setMinLoggingLevel(mrpt::system::VerbosityLevel(ini.read_int("OptimizerParameters", "class_verbosity", 1)));
    const std::string section = "VisualizationParameters";
    drawing_["show_ID_labels"] = ini.read_bool(section, "optimized_show_ID_labels", false);
    drawing_["show_ground_grid"] = ini.read_bool(section, "optimized_show_ground_grid", true);
    drawing_["show_edges"] = ini.read_bool(section, "optimized_show_edges", true);
    drawing_["edge_width"] = ini.read_double(section, "optimized_edge_width", 1.5);
    drawing_["show_node_corners"] = ini.read_bool(section, "optimized_show_node_corners", true);
    drawing_["nodes_corner_scale"] = ini.read_double(section, "optimized_nodes_corner_scale", 0.1);
  }

  bool updateState(ActionPtr, SensoryFramePtr, ObservationPtr) override {
    just_solved_ = false;
    if (this->m_graph->nodes.empty()) return true;
    const bool more_nodes = this->m_graph->nodeCount() != network_.poses.size();
    if (!more_nodes && this->m_graph->edges.size() == edges_.size()) return true;
    takeEdges();
    takeNodes();
    if (due()) optimizeGraph();
    restore();
    return true;
  }
  bool justFullyOptimizedGraph() const override { return just_solved_; }

  void restore() override {
    for (const auto& [id, pose] : network_.poses) {
      const auto node = this->m_graph->nodes.find(static_cast<mrpt::graphs::TNodeID>(id.value));
      if (node != this->m_graph->nodes.end())
        static_cast<typename GRAPH::constraint_no_pdf_t&>(node->second) = toNode<GRAPH>(pose);
    }
  }

  void finish() override {
    takeEdges();
    takeNodes();
    if (edges_.size() + 1 > network_.poses.size())
      solve({.max_iterations = options_.max_iterations, .function_tolerance = options_.final_tolerance, .dogleg = true});
    restore();
  }

  void getDescriptiveReport(std::string* report) const override {
    *report += mrpt::format(
        "Factor graph with robust losses [CFactorGraphGSO]\n"
        "%zu nodes, %zu edges, %d of them loop closures, %d left out as they hold no numbers; solved %d times, %d without "
        "a usable solution\n"
        "cost of the last solution: %g\n",
        network_.poses.size(), edges_.size(), closures_, unusable_, solutions_, failures_, cost_);
    *report += this->getLogAsString();
  }

  void initializeVisuals() override {
    mrpt::graphslam::CRegistrationDeciderOrOptimizer<GRAPH>::initializeVisuals();
    this->m_win_manager->assignTextMessageParameters(&text_offset_, &text_index_);
  }
  void updateVisuals() override;
  void notifyOfWindowEvents(const std::map<std::string, bool>& events) override {
    mrpt::graphslam::CRegistrationDeciderOrOptimizer<GRAPH>::notifyOfWindowEvents(events);
    const auto clicked = events.find("mouse_clicked");
    if (clicked != events.end() && clicked->second) follow_ = false;
  }

 protected:
  void optimizeGraph() override {
    solve({.max_iterations = kLiveIterations, .function_tolerance = options_.live_tolerance});
    unsolved_ = 0;
    surprised_ = false;
    just_solved_ = true;
  }

 private:
  static constexpr int kLiveIterations = 10;
  static constexpr double kMovementRobustWidth = 3;  // Cauchy, in standard deviations: wheels slip

  static BetweenFactor toFactor(const Edge& edge, const BackendOptions& options) {
    const Movement movement = toMovement(edge.second);
    const NodeId a{static_cast<std::int64_t>(edge.first.first)}, b{static_cast<std::int64_t>(edge.first.second)};
    BetweenFactor out{a, b, movement.a_from_b, movement.covariance, kMovementRobustWidth};
    if (isClosure(out, options)) out.robust_width = options.closure_robust_width;
    return out;
  }

  static bool isClosure(const BetweenFactor& edge, const BackendOptions& options) {
    return std::abs(edge.a.value - edge.b.value) > std::max(1, options.local_map_nodes);
  }

  // MRPT's ICP of images gives edges without numbers.
  void takeEdge(const Edge& edge) {
    if (edge.second.cov_inv.asEigen().allFinite() && poseOf(edge.second.mean).matrix().allFinite())
      fresh_.push_back(toFactor(edge, options_));
    else
      ++unusable_;
  }

  // Edges are never removed from a graph while an engine runs, and have fixed places in it.
  void takeEdges() {
    if (this->m_graph->edges.size() == edges_.size()) return;
    for (const Edge& edge : this->m_graph->edges)
      if (edge.first.first != edge.first.second && !edges_.contains(&edge)) takeEdge(edge);
    for (const Edge& edge : this->m_graph->edges) edges_.insert(&edge);
    for (const auto& factor : fresh_) closures_ += isClosure(factor, options_);
  }

  // New nodes continue our estimate by the first edge that leads to them.
  void takeNodes() {
    auto& poses = network_.poses;
    if (poses.empty()) poses.emplace(network_.root, Pose3::Identity());
    for (const auto& [id, pose] : this->m_graph->nodes) {
      const NodeId node{static_cast<std::int64_t>(id)};
      if (poses.contains(node)) continue;
      const auto edge = std::find_if(fresh_.begin(), fresh_.end(),
                                     [&](const auto& e) { return e.b == node && poses.contains(e.a); });
      poses.emplace(node, edge != fresh_.end() ? Pose3(poses.at(edge->a) * edge->a_from_b) : poseOf(pose));
      ++unsolved_;
    }
    for (const auto& factor : fresh_) {
      if (isClosure(factor, options_)) surprised_ = surprised_ || surprising(factor);
      network_.edges.push_back(factor);
    }
    fresh_.clear();
  }

  bool surprising(const BetweenFactor& closure) const {
    const auto &a = network_.poses.at(closure.a), &b = network_.poses.at(closure.b);
    const Pose3 difference = closure.a_from_b.inverse() * a.inverse() * b;
    return difference.translation().norm() > options_.urgent_closure_m ||
           rotationAngle(difference) > options_.urgent_closure_rad;
  }

  // The pause grows with the graph, so that the work per node stays bounded.
  bool due() const {
    const int nodes = static_cast<int>(network_.poses.size());
    const int pause = surprised_ ? std::max(options_.optimize_every_nodes / 4, nodes / 100)
                                 : std::max(options_.optimize_every_nodes, nodes / 10);
    return edges_.size() + 1 > network_.poses.size() && unsolved_ >= pause;
  }

  void solve(const SolveOptions& until) {
    const SolveReport report = optimize(network_, until);
    ++solutions_;
    failures_ += !report.usable;
    cost_ = report.final_cost;
    MRPT_LOG_DEBUG_STREAM("solved " << network_.poses.size() << " nodes, " << network_.edges.size()
                                    << " edges: " << report.message);
  }

  const BackendOptions options_;
  PoseNetwork network_;
  std::set<const Edge*> edges_;  ///< those in the network
  std::vector<BetweenFactor> fresh_;
  mrpt::containers::yaml drawing_ = mrpt::containers::yaml::Map();
  int unsolved_ = 0, closures_ = 0, unusable_ = 0, solutions_ = 0, failures_ = 0;
  double cost_ = 0, text_offset_ = 0;
  int text_index_ = 0;
  bool surprised_ = false, just_solved_ = false, follow_ = true;
};

/// Turns the camera to all nodes.
template <class GRAPH>
void showAll(const GRAPH& graph, mrpt::gui::CDisplayWindow3D& window) {
  Eigen::AlignedBox2d box;
  for (const auto& [id, node] : graph.nodes) box.extend(Eigen::Vector2d(node.x(), node.y()));
  window.setCameraPointingToPoint(static_cast<float>(box.center().x()), static_cast<float>(box.center().y()), 0);
  window.setCameraZoom(static_cast<float>(6 + 2 * box.sizes().maxCoeff()));
}

/// Draws the graph as MRPT's optimizers do, under the same name.
template <class GRAPH>
void CFactorGraphGSO<GRAPH>::updateVisuals() {
  mrpt::graphslam::CRegistrationDeciderOrOptimizer<GRAPH>::updateVisuals();
  const std::string name = "optimized_graph";
  auto& scene = this->m_win->get3DSceneAndLock();
  if (const auto former = scene->getByName(name)) scene->removeObject(former);
  auto drawn = mrpt::opengl::CSetOfObjects::Create();
  restore();
  this->m_graph->getAs3DObject(drawn, drawing_);
  drawn->setName(name);
  scene->insert(drawn);
  this->m_win->unlockAccess3DScene();
  this->m_win_manager->addTextMessage(
      5, -text_offset_, mrpt::format("Factor graph: %zu nodes, %d closures", network_.poses.size(), closures_),
      mrpt::img::TColorf(0, 0, 0), static_cast<std::size_t>(text_index_));
  if (follow_) showAll(*this->m_graph, *this->m_win);  // until somebody moves it
  this->m_win->forceRepaint();
}

}  // namespace roomgraph
