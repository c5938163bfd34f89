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
/// wheels, whichever there are: an edge by the best of them, and one by each of the others.
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
    const auto movements = front_end_.movementsSince(since, kPlanar<GRAPH>);
    toConstraint(movements.front(), this->m_since_prev_node_PDF);
    const Pose3& moved = movements.front().a_from_b;
    if (moved.translation().norm() <= distance_m_ && rotationAngle(moved) <= angle_rad_ && *now - since <= interval_s_)
      return false;
    registerNode(movements, first);
    front_end_.noteNodes(this->m_graph->nodeCount(), *now);
    return true;
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

  void registerNode(const std::vector<Movement>& movements, bool first) {
    this->registerNewNodeAtEnd(constraint_t(this->m_since_prev_node_PDF));
    const auto to = this->m_prev_registered_nodeID;
    const auto from = to - 1;
    // The base class puts the root where the robot is now.
    if (first) this->m_graph->nodes[this->m_graph->root] = typename GRAPH::constraint_no_pdf_t();
    for (std::size_t i = 1; i < movements.size(); ++i) {
      constraint_t further;
      toConstraint(movements[i], further);
      this->m_graph->insertEdge(from, to, further);
    }
    this->resetPDF(&this->m_since_prev_node_PDF);
  }

  EngineFrontEnd& front_end_;
  double distance_m_, angle_rad_, interval_s_;
};

}  // namespace roomgraph
