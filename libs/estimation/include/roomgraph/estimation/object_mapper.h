// SPDX-License-Identifier: BSD-3-Clause
// Mapping of objects: association, landmark fusion, negative evidence and re-association.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "roomgraph/association/landmark_map.h"
#include "roomgraph/estimation/key_poses.h"
#include "roomgraph/estimation/object_factors.h"
#include "roomgraph/estimation/pose_estimator.h"
#include "roomgraph/observations/frame.h"
#include "roomgraph/observations/scan.h"
#include "roomgraph/observations/seen_span.h"

namespace roomgraph {

/// The object part of a run: association (method.md sec. 4, E-step), and the memory of what was measured, relative
/// to the robot, so that it can be judged again when poses have moved.
class ObjectMapper {
 public:
  /// `pose_sigma_m`: uncertainty of the current pose when objects are associated. `poses` outlives the mapper.
  ObjectMapper(std::shared_ptr<Associator> associator, const LandmarkOptions& options, double pose_sigma_m,
               const KeyPoses& poses)
      : associator_(std::move(associator)), landmarks_(options), pose_sigma_m_(pose_sigma_m), poses_(poses) {}

  /// The measurements of one frame: gives them to landmarks and fuses them. `features`: tracked in that frame.
  std::vector<ObjectDecision> associate(const std::vector<ObjectMeasurement>& measurements, const Frame& frame,
                                        const std::vector<FeatureTrack>& features);

  /// Lowers the existence of landmarks in good view where the detector, on this frame, found nothing.
  void missUnseen(const std::vector<ObjectDecision>& decisions, const std::vector<Detection>& detections,
                  const Frame& frame);

  /// What a scan says of the landmarks it crosses, by what of their classes stops beams; one from each place.
  void observe(const Scan& scan, const Pose3& world_from_robot, const ObjectDatabase& database);

  /// Merges landmarks that turned out to be one object, in the memory too; splits those that are two.
  void tidy();

  /// E-step over everything measured so far, with the poses as they are now (method.md sec. 4); whether a
  /// decision changed. Does nothing with an associator whose decisions are final.
  bool reassociate();

  /// Moves the landmarks that were first seen then or later.
  void move(const PathShift& shift);

  /// What the graph is to know, with the weights and options of the back end.
  ObjectsInGraph inGraph(const ObjectDatabase& database, const BackendOptions& options) const;
  /// Takes over where an optimisation of the graph puts the landmarks.
  void apply(const LandmarkEstimates& estimates);

  const std::vector<ObjectFrame>& frames() const { return frames_; }
  const LandmarkMap& landmarks() const { return landmarks_; }
  const SeenSpans& seenSpans() const { return spans_; }

 private:
  std::vector<std::vector<WorldMeasurement>> measurementsInWorld() const;
  void shareSightings(LandmarkId first, LandmarkId second);
  void respan();
  void span(const ObjectFrame& frame);

  std::shared_ptr<Associator> associator_;
  LandmarkMap landmarks_;
  double pose_sigma_m_;
  const KeyPoses& poses_;
  std::vector<ObjectFrame> frames_;
  SeenSpans spans_;
  std::optional<Pose3> last_rays_from_;
};

}  // namespace roomgraph
