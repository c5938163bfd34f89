// SPDX-License-Identifier: BSD-3-Clause
// ViewState: what a viewer shows of one moment of a run; immutable, so that threads share it.
#pragma once

#include <mrpt/maps/COccupancyGridMap2D.h>

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "roomgraph/pipeline/step_report.h"

namespace roomgraph {

/// A pose of the robot seen from above, in world: m, rad; small, as every moment keeps the path as it was
/// then.
struct ShownPose {
  double t = 0;
  float x = 0, y = 0, z = 0, yaw = 0;
};
using ShownPath = std::vector<ShownPose>;

/// A landmark as it was known at the moment.
struct ShownLandmark {
  Landmark landmark;
  bool in_map = true;                      ///< false: a candidate that is not believed, or not yet
  std::map<std::string, double> evidence;  ///< for and against its existence by name, where known
};
using ShownLandmarks = std::vector<std::shared_ptr<const ShownLandmark>>;

/// An object as one frame shows it.
struct ShownShape {
  std::string class_name;
  ObjectShape shape;
  Pose3 world_from_object = Pose3::Identity();
};

/// One measurement of a landmark and why it was taken for that one.
struct ShownSighting {
  LandmarkId landmark;
  double t = 0;
  bool made_new = false;        ///< no known landmark was likelier
  double probability = 0;       ///< of the decision
  double confidence = 0;        ///< of the selection (method.md sec. 3)
  double score = 0;             ///< initialisation score of the shape
  EnergyTerms energy;           ///< of the selection
  WeightedLandmarks posterior;  ///< of the association; the invalid id: new
  std::string source;           ///< what made the shape: "depth", …
};

/// Times of the two key poses that a loop closure ties, s.
struct ShownClosure {
  double t_a = 0, t_b = 0;
};

/// One moment of a run. What does not change from one to the next is shared.
struct ViewState {
  int record = 0;  ///< number of frames and scans up to this one
  double t = 0;
  Pose3 world_from_robot = Pose3::Identity();
  bool planar = true;                                           ///< false: a handheld camera
  std::string note;                                             ///< what went wrong; empty when all is well
  std::shared_ptr<const mrpt::maps::COccupancyGridMap2D> grid;  ///< null: none yet
  std::shared_ptr<const ShownPath> path;                        ///< may go on after this moment
  std::shared_ptr<const ShownPath> key_poses;
  std::shared_ptr<const ShownLandmarks> landmarks;
  std::shared_ptr<const std::vector<ShownClosure>> closures;
  std::shared_ptr<const LandmarkIdentity> identity;  ///< which landmarks became one; null: ids are final
  std::vector<Eigen::Vector3f> scan;                 ///< returns in world
  std::vector<ShownShape> proposals, people;         ///< of the last frame
  std::shared_ptr<const StepReport> frame;  ///< of the last frame, without anything as large as an image
  std::vector<ShownSighting> sightings;     ///< of this moment
  /// Those of the whole run when they are known with hindsight; then `sightings` are not used.
  std::shared_ptr<const std::vector<ShownSighting>> all_sightings;
  std::size_t loop_closures = 0;  ///< of a long run, whose `closures` are ties between bodies of key poses: found in all; else 0
};
using ViewStates = std::vector<std::shared_ptr<const ViewState>>;

/// A frame with its image and all that was made of it.
struct SeenFrame {
  StepReport report;  ///< `image` points to `frame`
  Frame frame;
};

ShownPose toShown(const StampedPose& stamped);
/// The landmark of that id; null when it is not there.
const ShownLandmark* findLandmark(const ViewState& state, LandmarkId id);
/// The part of the path up to the moment.
std::vector<StampedPose> pathUntil(const ShownPath& path, double t);

}  // namespace roomgraph
