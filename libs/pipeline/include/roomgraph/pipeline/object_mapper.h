// SPDX-License-Identifier: BSD-3-Clause
// Mapping of objects: selection, association, landmark fusion and re-association.
#pragma once

#include <map>
#include <vector>

#include "roomgraph/association/landmark_map.h"
#include "roomgraph/observations/seen_span.h"
#include "roomgraph/pipeline/key_poses.h"
#include "roomgraph/pipeline/object_factors.h"
#include "roomgraph/pipeline/stages.h"
#include "roomgraph/pipeline/step_report.h"

namespace roomgraph {

/// The object part of a run: selection (method.md sec. 3), association (sec. 4, E-step), and the memory of
/// what was measured, relative to the robot, so that it can be judged again when poses have moved.
class ObjectMapper {
 public:
  /// Both outlive the mapper.
  ObjectMapper(Stages& stages, const KeyPoses& poses)
      : stages_(stages), poses_(poses), landmarks_(stages.landmarks) {}

  /// One frame on which there are detections: chooses proposals, gives them to landmarks, fuses them.
  std::vector<ObjectDecision> observe(const FrameProposals& seen, const Frame& frame,
                                      const std::vector<FeatureTrack>& features);

  /// Lowers the existence of landmarks in good view where the detector, on this frame, found nothing.
  void missUnseen(const std::vector<ObjectDecision>& decisions, const std::vector<Detection>& detections,
                  const Frame& frame);

  /// What a scan says of the landmarks it crosses; one from each place.
  void observe(const Scan& scan, const Pose3& world_from_robot);

  /// Joins landmarks that turned out to be one object, in the memory too; parts those that are two.
  void tidy();

  /// E-step over everything measured so far, with the poses as they are now (method.md sec. 4); whether a
  /// decision changed. Does nothing with an associator whose decisions are final.
  bool reassociate();

  /// Moves the landmarks that were first seen at that time or later.
  void moveSince(double t, const Pose3& new_from_old);

  /// What the graph is to know.
  ObjectFactors factors() const;

  const std::vector<ObjectFrame>& frames() const { return frames_; }
  LandmarkMap& landmarks() { return landmarks_; }
  const LandmarkMap& landmarks() const { return landmarks_; }
  const SeenSpans& seenSpans() const { return spans_; }

 private:
  std::vector<WorldMeasurement> select(const FrameProposals& seen, const Frame& frame,
                                       const std::vector<FeatureTrack>& features) const;
  std::vector<std::vector<WorldMeasurement>> measurementsInWorld() const;
  void shareSightings(LandmarkId first, LandmarkId second);
  void respan();
  void span(const ObjectFrame& frame);

  Stages& stages_;
  const KeyPoses& poses_;
  LandmarkMap landmarks_;
  std::vector<ObjectFrame> frames_;
  SeenSpans spans_;
  std::optional<Pose3> last_rays_from_;
};

}  // namespace roomgraph
