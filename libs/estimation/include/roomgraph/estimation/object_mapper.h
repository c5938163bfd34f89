// SPDX-License-Identifier: BSD-3-Clause
// Mapping of objects: association, landmark fusion, negative evidence and re-association.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "roomgraph/association/landmark_map.h"
#include "roomgraph/estimation/drift.h"
#include "roomgraph/estimation/existence.h"
#include "roomgraph/estimation/key_poses.h"
#include "roomgraph/estimation/landmark_continuation.h"
#include "roomgraph/estimation/object_factors.h"
#include "roomgraph/estimation/pose_estimator.h"
#include "roomgraph/observations/frame.h"
#include "roomgraph/observations/scan.h"
#include "roomgraph/observations/seen_span.h"

namespace roomgraph {

class SpaceMemory;

/// Which measurements belong together: for each in turn the number of its object, counted as they appear.
using Partition = std::vector<int>;

/// The object part of a run: association (method.md sec. 4, E-step), and the storage of all measurements
/// relative to the robot, so that they can be decided again when the poses have changed.
class ObjectMapper {
 public:
  /// `pose_sigma_m`: uncertainty of the current pose within what it sees, besides drift. `poses` outlives the
  /// mapper.
  ObjectMapper(std::shared_ptr<Associator> associator, const LandmarkOptions& options, double pose_sigma_m,
               const KeyPoses& poses);
  ~ObjectMapper();

  /// Assigns the measurements of one frame to landmarks and fuses them. `features`: tracked in that frame.
  /// `drift`: of the pose since each landmark was last seen.
  std::vector<ObjectDecision> associate(const std::vector<ObjectMeasurement>& measurements,
                                        const Frame& frame, const std::vector<FeatureTrack>& features,
                                        const Drift& drift);

  /// Lowers the scores of measured shapes whose solid part the beams of the latest scan pass through:
  /// something is wrong with their place. From the score follow their trust in association, existence and
  /// graph.
  void doubtByScan(std::vector<ObjectMeasurement>& measurements, const Frame& frame,
                   const ObjectDatabase& database) const;

  /// Lowers the existence of landmarks in good view where the detector, on this frame, found nothing; not of the classes in
  /// `unsought`, for which it did not look.
  void missUnseen(const std::vector<ObjectDecision>& decisions, const std::vector<Detection>& detections,
                  const Frame& frame, const std::vector<std::string>& unsought = {});

  /// Updates the existence of the landmarks that a scan crosses, by how much of their classes is solid; scans
  /// from one place count once.
  void observe(const Scan& scan, const Pose3& world_from_robot, const ObjectDatabase& database);

  /// Remembers what the depth image saw free and filled; the boxes of people hide what is behind them.
  void look(const Frame& frame, const Pose3& world_from_robot, const std::vector<Box2>& people);

  /// Every landmark with what the whole run says about its existence; without a model that is the filter's.
  std::vector<Candidate> candidates(const ObjectDatabase& database, const ExistenceModel* model) const;

  /// Merges landmarks that are one object, also in the stored measurements; splits those that are two.
  void tidy();

  /// Landmarks that sightings and depth images say were moved stand where they were seen last; what was seen of them before is
  /// forgotten. Asked are those that were sighted at `since_t` or later. Not those that may only seem so, by the drift of the pose
  /// since, and not those that were carried farther than two of a kind can stand apart: these are two landmarks. No loop closure
  /// waits for an optimisation: drift is little then, and poses are not where they should be.
  void followMoved(const Drift& drift, double since_t);
  /// Since when it stands where it stands, if it was moved, s.
  std::optional<double> standsSince(LandmarkId id) const;

  /// E-step over everything measured so far, with the current poses (method.md sec. 4), and tidy(). An associator
  /// without a model decides every frame again by its own rule. Whether it was done: not without LandmarkOptions::hindsight.
  bool reassociate();
  Partition whoIsWho() const;

  /// The landmarks of an earlier map, in whose frame world is: those measured again take over their ids.
  void continueIds(const std::vector<Landmark>& earlier);
  /// Ids of an earlier map, up to this one, are left free.
  void reserveIds(LandmarkId last) { landmarks_.reserveIds(last); }
  /// What the run saw of the places of these landmarks, in order.
  std::vector<PlaceLook> looksAt(const std::vector<Landmark>& landmarks,
                                 const ObjectDatabase& database) const;

  /// Looks through sightings, images and scans when there are more than `kept` of a kind, and gives up those that others from
  /// that place in that direction repeat; called now and then. `until_lately`: the robot's poses but those of the last moments, of
  /// which nothing is given up. Of every landmark forty sightings at least are kept. Who is who of the others stays known, and
  /// what they say about existence.
  void giveUpRepeated(std::size_t kept, const Trajectory& until_lately);

  /// Moves the landmarks that were first seen then or later.
  void move(const PathShift& shift);

  /// Factors for the graph, with the weights and options of the back end.
  ObjectsInGraph inGraph(const ObjectDatabase& database, const BackendOptions& options) const;
  /// The same from a copy of what the mapper knows now, for poses that are given. What is referred to outlives it.
  ObjectsAtPoses inGraphLater(const ObjectDatabase& database, const BackendOptions& options) const;
  /// Sets the landmarks to the result of an optimisation of the graph.
  void apply(const LandmarkEstimates& estimates);

  const ObjectFrames& frames() const { return frames_; }
  const LandmarkMap& landmarks() const { return landmarks_; }
  const SeenSpans& seenSpans() const { return spans_; }

 private:
  std::vector<std::vector<WorldMeasurement>> measurementsInWorld() const;
  std::map<LandmarkId, double> driftVariances(const Drift& drift) const;
  void goOnFrom(const Landmark& optimum);
  void renameSightings();
  void shareSightings(LandmarkId first, LandmarkId second);
  void respan();
  void span(const ObjectFrame& frame);
  void span(LandmarkId landmark, double t);
  void forgetBefore(double t, LandmarkId landmark);
  std::vector<Landmark> landmarksNow() const;
  FormerSighting former(const ObjectFrame& frame, const ObjectDecision& decision) const;
  void findHomes(const Reassociation& result);

  std::shared_ptr<Associator> associator_;
  LandmarkMap landmarks_;
  double pose_sigma_m_;
  bool hindsight_;
  const KeyPoses& poses_;
  ObjectFrames frames_;
  GrowthWatch frames_watch_;
  SeenSpans spans_;
  std::vector<std::pair<LandmarkId, double>> moved_;  ///< since when, s; by the ids of then
  std::optional<Pose3> last_rays_from_;
  std::optional<Scan> latest_scan_;  ///< without returns on people
  std::unique_ptr<SpaceMemory> space_;
  std::vector<SearchedImage> searched_;  ///< images that the detector saw, in order
};

}  // namespace roomgraph
