// SPDX-License-Identifier: BSD-3-Clause
// Node registration decider: key poses of our front ends.
#pragma once

#include "engine_step.h"
#include "roomgraph/geometry/degree.h"
#include "roomgraph/graphslam/constraints.h"
#include "roomgraph/graphslam/engine_front_end.h"
#include "semantic_annotations.h"

namespace roomgraph {

/// Registers a node when the robot has moved far enough since the last one, by scan matching, RGB-D odometry and
/// wheels, whichever there are. The edge from the last node is that of the wheels, if there are any. Scans and images
/// are matched to local maps: their edges lead from the node at the beginning of one to each of the next nodes
/// ([backend] local_map_nodes), as in a run (method.md sec. 4.4, factor 1).
///
/// [NodeRegistrationDeciderParameters]: registration_max_distance (m), registration_max_angle (deg),
/// registration_max_interval (s); those of [backend] of the configuration when they are not there.
template <class GRAPH>
class CKeyPosesNRD : public mrpt::graphslam::deciders::CNodeRegistrationDecider<GRAPH> {
 public:
  using typename mrpt::graphslam::deciders::CNodeRegistrationDecider<GRAPH>::constraint_t;

  /// The front end outlives the decider.
  explicit CKeyPosesNRD(EngineFrontEnd& front_end) : front_end_(front_end) {
    const BackendOptions& options = front_end.setup().options.backend;
    distance_m_ = options.node_distance_m;
    angle_rad_ = options.node_angle_rad;
    interval_s_ = options.node_interval_s;
    this->initializeLoggers("CKeyPosesNRD");
  }

  void loadParams(const std::string& file) override {
    const mrpt::config::CConfigFile ini(file);
    const std::string section = "NodeRegistrationDeciderParameters";
    distance_m_ = ini.read_double(section, "registration_max_distance", distance_m_);
    angle_rad_ = ini.read_double(section, "registration_max_angle", angle_rad_ * kDegreesPerRadian) / kDegreesPerRadian;
    interval_s_ = ini.read_double(section, "registration_max_interval", interval_s_);
    this->setMinLoggingLevel(mrpt::system::VerbosityLevel(ini.read_int(section, "class_verbosity", 1)));
    if (distance_m_ <= 0 || angle_rad_ <= 0 || interval_s_ <= 0)
      throw std::runtime_error("[" + section + "]: registration_max_distance, _angle and _interval must be above 0");
  }

  bool updateState(ActionPtr action, SensoryFramePtr observations, ObservationPtr observation) override {
    front_end_.take(objectsOf(action, observations, observation));
    const auto now = front_end_.now();
    if (!now) return false;
    const bool first = this->m_prev_registered_nodeID == mrpt::graphs::INVALID_NODEID;
    const double since = first ? *front_end_.firstTime() : front_end_.timeOf(lastNode());
    if (*now <= since) return false;
    const Movement movement = front_end_.movementSince(since, kPlanar<GRAPH>);
    toConstraint(movement, this->m_since_prev_node_PDF);
    const Pose3& moved = movement.a_from_b;
    if (moved.translation().norm() <= distance_m_ && rotationAngle(moved) <= angle_rad_ && *now - since <= interval_s_)
      return false;
    registerNode(since, first);
    front_end_.noteNodes(this->m_graph->nodeCount(), *now);
    return true;
  }

  // A node begins as a copy of the one before, annotations and all.
  void addNodeAnnotsToPose(typename GRAPH::global_pose_t* pose) const override {
    static_cast<typename GRAPH::node_annotations_t&>(*pose) = {};
  }

  void getDescriptiveReport(std::string* report) const override {
    mrpt::graphslam::deciders::CNodeRegistrationDecider<GRAPH>::getDescriptiveReport(report);
    const FrontEndCounts& counts = front_end_.counts();
    *report += mrpt::format(
        "Key poses of scan matching, RGB-D odometry and wheels [CKeyPosesNRD]\n"
        "a node every %.3f m, %.1f deg or %.1f s\n"
        "scans %d, not matched %d; frames %d, not tracked %d; odometry %d; out of order %d\n",
        distance_m_, angle_rad_ * kDegreesPerRadian, interval_s_, counts.scans, counts.scans_unmatched, counts.frames,
        counts.frames_lost, counts.odometry, counts.disordered);
    *report += this->getLogAsString();
  }

 private:
  NodeId lastNode() const { return NodeId{static_cast<std::int64_t>(this->m_prev_registered_nodeID)}; }

  void registerNode(double since, bool first) {
    toConstraint(front_end_.stepSince(since, kPlanar<GRAPH>), this->m_since_prev_node_PDF);
    this->registerNewNodeAtEnd(constraint_t(this->m_since_prev_node_PDF));
    if (first) {
      // The base class puts the root where the robot is now.
      this->m_graph->nodes[this->m_graph->root] = typename GRAPH::constraint_no_pdf_t();
      front_end_.noteNodes(1, *front_end_.firstTime());
    }
    addLocalMapEdges(this->m_prev_registered_nodeID);
    this->resetPDF(&this->m_since_prev_node_PDF);
  }

  // The last node of a local map is the first one of the next. One that lost its sources begins anew.
  void addLocalMapEdges(mrpt::graphs::TNodeID to) {
    const auto length = static_cast<mrpt::graphs::TNodeID>(std::max(1, front_end_.setup().options.backend.local_map_nodes));
    if (to - local_map_ > length) local_map_ = to - 1;
    const auto timeOf = [&](auto id) { return front_end_.timeOf(NodeId{static_cast<std::int64_t>(id)}); };
    auto movements = front_end_.inLocalMapSince(timeOf(local_map_));
    if (movements.empty()) movements = front_end_.inLocalMapSince(timeOf(local_map_ = to - 1));
    for (const Movement& movement : movements) {
      constraint_t edge;
      toConstraint(movement, edge);
      this->m_graph->insertEdge(local_map_, to, edge);
    }
  }

  mrpt::graphs::TNodeID local_map_ = 0;  ///< where it begins
  EngineFrontEnd& front_end_;
  double distance_m_, angle_rad_, interval_s_;
};

}  // namespace roomgraph
