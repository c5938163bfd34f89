// SPDX-License-Identifier: BSD-3-Clause
// MRPT's engine with its parts, whose poses are those of an optimizer that keeps them.
#pragma once

#include <cmath>
#include <memory>

#include "engine_step.h"
#include "factor_graph_optimizer.h"
#include "object_decider.h"

namespace roomgraph {

/// Node decider, edge decider and optimizer of an engine, which does not own them.
template <class GRAPH>
struct OwnedParts {
  std::unique_ptr<mrpt::graphslam::deciders::CNodeRegistrationDecider<GRAPH>> node;
  std::unique_ptr<mrpt::graphslam::deciders::CEdgeRegistrationDecider<GRAPH>> edge;
  std::unique_ptr<mrpt::graphslam::optimizers::CGraphSlamOptimizer<GRAPH>> optimizer;
};

/// The stock engine; only after each step an optimizer that is a PoseKeeper puts its poses back.
template <class GRAPH>
class HostedEngine : public mrpt::graphslam::CGraphSlamEngine<GRAPH> {
 public:
  using Base = mrpt::graphslam::CGraphSlamEngine<GRAPH>;

  /// `parts` and `window` outlive the engine. Throws what MRPT throws.
  HostedEngine(const std::string& ini, const std::string& rawlog, const std::string& truth,
               mrpt::graphslam::CWindowManager* window, const OwnedParts<GRAPH>& parts)
      : Base(ini, rawlog, truth, window, parts.node.get(), parts.edge.get(), parts.optimizer.get()),
        keeper_(dynamic_cast<PoseKeeper*>(parts.optimizer.get())) {}

  bool _execGraphSlamStep(ActionPtr& action, SensoryFramePtr& observations, ObservationPtr& observation,
                          std::size_t& entry) override {
    if (this->m_use_GT && this->m_GT_poses_index >= this->m_GT_poses.size()) {
      truth_ended_ = true;  // the engine would read behind the end
      this->m_use_GT = false;
    }
    const auto nodes = this->m_graph.nodeCount();
    const bool goes_on = Base::_execGraphSlamStep(action, observations, observation, entry);
    if (keeper_ && this->m_graph.nodeCount() != nodes) {
      const std::lock_guard lock(this->m_graph_section);
      keeper_->restore();
    }
    return goes_on;
  }

  /// Does what the keys pressed in the window ask for; false when they ask for the end.
  bool answerKeys() {
    this->queryObserverForEvents();
    return !this->m_request_to_exit;
  }

  /// No more steps will come: our optimizer solves to the end, and what our front end (null: there is none) saw last
  /// becomes annotations.
  void finish(EngineFrontEnd* front_end) {
    {
      const std::lock_guard lock(this->m_graph_section);
      if (front_end) front_end->end();
      if (front_end && front_end->nodes() > 0) annotateNodes(this->m_graph, *front_end);
      if (keeper_) keeper_->finish();
    }
    if (!keeper_) return;
    this->m_map_is_cached = false;
    if (!this->m_enable_visuals || this->m_graph.nodes.empty()) return;
    if (this->m_visualize_map) {
      const std::lock_guard lock(this->m_graph_section);
      this->updateMapVisualization(this->m_nodes_to_laser_scans2D, true);
    }
    this->updateAllVisuals();
    this->updateEstimatedTrajectoryVisualization(true);
  }

  /// The map of the nodes with a scan; null when none has one.
  mrpt::maps::COccupancyGridMap2D::Ptr map() {
    std::erase_if(this->m_nodes_to_laser_scans2D, [](const auto& entry) { return !entry.second; });
    if (this->m_nodes_to_laser_scans2D.empty()) return nullptr;
    auto out = mrpt::maps::COccupancyGridMap2D::Create();
    this->getMap(out);
    return out;
  }

  bool truthEnded() const { return truth_ended_; }

 private:
  PoseKeeper* keeper_;
  bool truth_ended_ = false;
};

}  // namespace roomgraph
