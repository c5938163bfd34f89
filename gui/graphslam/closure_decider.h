// SPDX-License-Identifier: BSD-3-Clause
// Edge registration deciders: loop closures of our front ends.
#pragma once

#include <functional>

#include "engine_step.h"
#include "roomgraph/graphslam/constraints.h"
#include "roomgraph/graphslam/engine_front_end.h"
#include "semantic_annotations.h"

namespace roomgraph {

/// The nodes of the graph as they are now, for the front end.
template <class GRAPH>
void showNodes(const GRAPH& graph, EngineFrontEnd& front_end) {
  for (const auto& [id, pose] : graph.nodes) {
    const NodeId node{static_cast<std::int64_t>(id)};
    if (id < front_end.nodes()) front_end.setNode(node, poseOf(pose));
  }
}

/// Registers the loop closures of one source after every new node. Works beside any node registration decider: it
/// runs the front ends itself where that is none of ours.
template <class GRAPH>
class CClosuresERD : public mrpt::graphslam::deciders::CEdgeRegistrationDecider<GRAPH> {
 public:
  using typename mrpt::graphslam::deciders::CEdgeRegistrationDecider<GRAPH>::constraint_t;
  using Source = std::function<std::vector<BetweenFactor>(EngineFrontEnd&)>;

  /// `counter`: the kind of edge as which the engine counts them, one of its own. The front end outlives the decider.
  CClosuresERD(const std::string& name, const std::string& counter, EngineFrontEnd& front_end, Source source)
      : counter_(counter), front_end_(front_end), source_(std::move(source)) {
    this->initializeLoggers(name);
  }

  void loadParams(const std::string& file) override {
    const mrpt::config::CConfigFile ini(file);
    this->setMinLoggingLevel(
        mrpt::system::VerbosityLevel(ini.read_int("EdgeRegistrationDeciderParameters", "class_verbosity", 1)));
  }

  bool updateState(ActionPtr action, SensoryFramePtr observations, ObservationPtr observation) override {
    front_end_.take(objectsOf(action, observations, observation));
    this->m_just_inserted_lc = false;
    const std::size_t count = this->m_graph->nodeCount();
    const double t = timeOfStep(observations, observation);
    if (count == known_nodes_ || (std::isnan(t) && front_end_.nodes() < count)) return true;
    const auto first_new = std::exchange(known_nodes_, count);
    front_end_.noteNodes(count, t);
    showNodes(*this->m_graph, front_end_);
    for (const auto& closure : source_(front_end_)) registerClosure(closure);
    afterNodes(first_new);
    return true;
  }

  void getEdgesStats(std::map<std::string, int>* counts) const override {
    (*counts)[counter_] += closures_;
    (*counts)["LC"] += closures_;
  }

  void getDescriptiveReport(std::string* report) const override {
    mrpt::graphslam::deciders::CEdgeRegistrationDecider<GRAPH>::getDescriptiveReport(report);
    *report += mrpt::format("[%s]: %d loop closures\n", this->getClassName().c_str(), closures_);
    *report += this->getLogAsString();
  }

 protected:
  /// After new nodes were seen, the first of which is this one.
  virtual void afterNodes(mrpt::graphs::TNodeID first_new) { (void)first_new; }
  EngineFrontEnd& frontEnd() const { return front_end_; }

 private:
  void registerClosure(const BetweenFactor& closure) {
    constraint_t edge;
    toConstraint({closure.a_from_b, closure.covariance}, edge);
    const auto from = static_cast<mrpt::graphs::TNodeID>(closure.a.value);
    const auto to = static_cast<mrpt::graphs::TNodeID>(closure.b.value);
    this->registerNewEdge(from, to, edge);  // says so in the log
    this->m_graph->insertEdge(from, to, edge);
    this->m_just_inserted_lc = true;
    ++closures_;
  }

  std::string counter_;
  EngineFrontEnd& front_end_;
  Source source_;
  std::size_t known_nodes_ = 0;
  int closures_ = 0;
};

}  // namespace roomgraph
