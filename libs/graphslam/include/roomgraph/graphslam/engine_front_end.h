// SPDX-License-Identifier: BSD-3-Clause
// Front ends of a run behind MRPT's deciders: actions and observations in, movements and loop closures out.
#pragma once

#include <mrpt/serialization/CSerializable.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "roomgraph/backend/factors.h"
#include "roomgraph/datasets/record_converter.h"
#include "roomgraph/estimation/key_poses.h"
#include "roomgraph/graphslam/seen_object.h"
#include "roomgraph/pipeline/front_ends.h"
#include "roomgraph/pipeline/setup.h"

namespace roomgraph {

class ObjectFrontEnd;

/// How often records were used, and how often not.
struct FrontEndCounts {
  int scans = 0, scans_unmatched = 0, frames = 0, frames_lost = 0, odometry = 0, disordered = 0;
};

/// Odometry, scan matching, RGB-D odometry and their loop closing, shared by the deciders of one engine: each hands
/// over what the engine gave it, and the first one that does makes the work be done. The nodes are the engine's;
/// their times, which its graph does not have, and their poses are kept here.
class EngineFrontEnd {
 public:
  /// `recording`: beside which external images are.
  EngineFrontEnd(std::unique_ptr<Setup> setup, const std::filesystem::path& recording);
  ~EngineFrontEnd();

  /// What one step of the engine is about: an action and a sensory frame, or an observation; null ones are left
  /// out. Handed over again, it changes nothing.
  void take(const std::vector<mrpt::serialization::CSerializable::Ptr>& step);

  /// No more steps will come: objects, which are mapped with some delay, are seen to the end.
  void end();

  const Setup& setup() const { return *setup_; }
  const FrontEndCounts& counts() const { return counts_; }
  const ReadStatistics& statistics() const { return converter_.statistics(); }
  /// Times of the first and the latest record that tells a pose, s: of a frame or a scan; without any, of
  /// odometry. Nothing before it.
  std::optional<double> firstTime() const { return first_t_; }
  std::optional<double> now() const { return now_; }
  /// Movement from time t until now by the best source that covers it: for a planar graph scans, images, wheels; else
  /// images, scans, wheels; one that is bounded by the speed of a robot when none does.
  Movement movementSince(double t, bool planar) const;
  /// The same by wheels, whose errors add up from node to node; by the best source when they do not cover it.
  Movement stepSince(double t, bool planar) const;
  /// Movements from the beginning of a local map at time t until now, as scans and images were matched in it.
  std::vector<Movement> inLocalMapSince(double t) const;

  /// The engine's graph has so many nodes; those that are new are of time t, the first one of firstTime().
  void noteNodes(std::size_t count, double t);
  std::size_t nodes() const { return poses_.nodes().size(); }
  double timeOf(NodeId id) const { return poses_.node(id).t; }
  /// There must be one of that id.
  void setNode(NodeId id, const Pose3& world_from_robot) { poses_.set(id, world_from_robot); }
  /// The nodes, and the robot's poses between them.
  const KeyPoses& poses() const { return poses_; }

  /// Loop closures found since the last call, as edges between nodes; none within one node. Those of scans are
  /// looked for around the nodes as they are now.
  std::vector<BetweenFactor> takeScanClosures();
  std::vector<BetweenFactor> takeImageClosures();

  /// From now on objects are mapped, too, from the records that the first setup reads. Their setup is one of its own,
  /// as its stages keep what they see.
  void mapObjects(std::unique_ptr<Setup> setup);
  /// Nothing, or the same as of scans and images, by objects. Without mapObjects(): none.
  std::vector<BetweenFactor> takeObjectClosures();
  /// Objects seen since the last call, each from the node nearest in time. There must be a node.
  std::vector<std::pair<NodeId, SeenObject>> takeSeenObjects();
  /// Landmarks that are sure enough for a map.
  std::set<LandmarkId> confirmedLandmarks() const;

 private:
  void drain();
  void process(const Record& record);
  void process(const Scan& scan);
  void process(const Frame& frame);
  void tell(double t);
  std::vector<BetweenFactor> betweenNodes(const std::vector<RelativePose>& closures) const;

  std::unique_ptr<Setup> setup_;
  RecordConverter converter_;
  FrontEnds front_ends_;
  KeyPoses poses_;
  std::unique_ptr<ObjectFrontEnd> objects_;  ///< null: none are mapped
  FrontEndCounts counts_;
  std::vector<mrpt::serialization::CSerializable::Ptr> latest_step_;
  std::optional<double> first_t_, now_, last_scan_t_, last_frame_t_;
  bool only_odometry_ = true;
};

}  // namespace roomgraph
