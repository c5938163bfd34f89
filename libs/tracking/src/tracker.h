// SPDX-License-Identifier: BSD-3-Clause
// Tracker of the feature odometry: state, map and records of tracked frames.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "dense_chain.h"
#include "feature_extractor.h"
#include "local_map.h"
#include "matcher.h"
#include "movement_habits.h"
#include "pose_solver.h"
#include "roomgraph/core/read_ahead.h"
#include "roomgraph/tracking/rgbd_odometry.h"

namespace roomgraph {
class ResultStore;
}

namespace roomgraph::tracking {

struct LocatedView;

/// Lower bound for errors that the residuals do not show: calibration, depth bias, consistent mismatches.
Matrix6d floorCovariance(double sigma_m, double sigma_rad);

/// State and main loop of FeatureOdometry.
class Tracker {
 public:
  explicit Tracker(const TrackingParameters& parameters) : parameters_(parameters) {}
  void setResultStore(ResultStore& store) { results_ = &store; }
  TrackingResult track(const Frame& frame, const TrackingPrior& by_others);
  /// Finds the features of a frame before its turn; beside all else, but not beside itself.
  void foresee(const Frame& frame);
  Trajectory trajectory() const;
  std::vector<RelativePose> takeLoopClosures() { return std::exchange(closures_, {}); }
  std::optional<RelativePose> verifyLoop(const RelativePose& proposed) const;
  /// Keyframes that were not given up.
  int keyframesHeld() const { return static_cast<int>(map_.keyframes.size()) - given_up_; }

 private:
  /// The frame being tracked.
  struct View {
    const Frame* frame = nullptr;
    const TrackingPrior* prior = nullptr;
    cv::Mat gray;
    Features features;
    std::vector<std::int64_t> points;  ///< per feature, -1: none
    std::vector<std::int64_t> in_view;  ///< points that were predicted to be seen
    Pose3 odom_from_camera = Pose3::Identity();
    PoseSolution solution;
    int matches = 0;
    int moving = 0;  ///< features of something that moves before the camera
    bool jumped = false;  ///< relocalised in another place than the last view's, and not where other sensors say
  };
  /// What images alone tell.
  struct Sight {
    cv::Mat gray;
    Corners corners;
    Features features;  ///< with nothing left out
  };
  /// What a view is known by again.
  struct Sighting {
    const Features& features;
    const PinholeCamera& camera;
    cv::Mat thumbnail;
  };
  /// A tracked frame, held by a keyframe: when that moves, the frame moves along.
  struct Record {
    double t;
    int keyframe;
    Pose3 keyframe_from_camera;
    int segment;
  };

  /// Each tries to match the view to the map and to place it; on failure the view's points and pose are
  /// undefined.
  bool trackLastPoints(View& view, const Pose3& predicted, double radius_px);
  bool trackKeyframe(View& view, int keyframe, int min_inliers) const;
  bool relocalise(View& view);
  /// Whether the camera can have come to where the view seems to be since it was placed last: floors and doors repeat themselves.
  bool withinReach(const View& view) const;
  bool trackLocalMap(View& view);
  bool trackNear(View& view);
  bool findPose(View& view, const Pose3& previous);
  /// Whether the keyframe shows what the last tracked frame did.
  bool seesLastPoints(int keyframe) const;
  /// The pose of the view as a problem; `used`: the features that are in it.
  PoseProblem problemOf(const View& view, std::vector<std::size_t>& used) const;
  /// Solves for the pose of the view from its matched points and drops outliers.
  bool solve(View& view, int min_inliers, bool start_is_good) const;
  /// The same, where something may move before the camera: that gives up its points.
  bool solveWithMovers(View& view, const Pose3& predicted);
  /// Where the last view and what other sensors measured since lead; nothing when they missed a part of that.
  std::optional<PosePrior> measuredPose() const;
  /// Whether the view may be placed by what moved a moment ago: that is far from where it was measured to be.
  bool followsMover(const View& view) const;
  /// Whether other sensors lead on because a view may show nothing but what moved a moment ago.
  bool ledPastMover(double t) const;
  /// Where something moves in this view nothing is matched, and nothing should be seen.
  void leaveOutMover(View& view, std::vector<PointMatch>& matches) const;
  void giveUpMoving(View& view, const std::vector<std::size_t>& features);
  /// With what moved lately.
  TrackingPrior withMovers(const TrackingPrior& prior, double t) const;
  std::vector<std::int64_t> localPoints(const View& view) const;

  /// Grey image and features of the view.
  void see(View& view, const std::vector<Box2>& excluded);
  /// Tracks by the images.
  TrackingResult look(const Frame& frame, const TrackingPrior& prior);
  /// Takes over a located view that was kept.
  TrackingResult recall(const Frame& frame, const TrackingPrior& prior, const std::string& bytes);
  void requireKnown(const LocatedView& kept) const;
  /// Keeps a located view for recall(); of a frame for which all has to be done again null.
  void keep(const View* view);
  /// Whether views may be where they seem to be by a keyframe: elsewhere walls look alike, too.
  bool plausible(int keyframe, const std::vector<PlacedSketch>& here, const Pose3& keyframe_from_here) const;
  std::vector<PlacedSketch> around(int keyframe) const;
  /// Notes in the map which points were seen, and which might have been.
  void count(const View& view);

  TrackingResult start(View view);
  TrackingResult lost(const std::string& reason, View* view);
  TrackingResult accept(const View& view, const Pose3& previous);
  /// A view of an older place whose map has drifted or is another one: tied to that place, in a segment of its own.
  void goElsewhere(const View& view);
  /// Where the frame is by dense alignment with the frames since the last one that features placed, when no scans
  /// saw the movement: from then on that is dead reckoning. Whether it is known.
  bool alignDensely(const Frame& frame, const TrackingPrior& prior);
  /// The movements since a frame that features placed become habits, when they went far enough.
  void learnHabits(double t);
  /// A step of the camera as it is expected to go on, by the habits of the robot that carries it.
  Pose3 expected(const Pose3& step) const;
  /// Fills in what a frame that only dense alignment or the velocity placed reports.
  void acceptDense(const Frame& frame, TrackingResult& result);
  /// A segment begins at this time: its link to the last one, if dense alignment knows it.
  void linkSegments(double t);
  /// Fills in what a tracked frame reports; its record must be the last one.
  void report(const Features& features, const std::vector<std::int64_t>& points,
              TrackingResult& result) const;
  bool needsKeyframe(const View& view) const;
  void addKeyframe(const View& view, int origin);
  void closeLoops(int keyframe);
  /// Keyframes that show what older ones show are given up: memory grows with what is seen, not with time.
  void giveUpRepeated();
  /// An older keyframe that shows what this one shows, from nearly the same place.
  std::optional<int> olderSameView(int keyframe) const;
  /// Where keyframe `index` is in the frame of another one that shows the same (camera_from_world of the solution is
  /// index_from_other); nothing when that is not sure.
  std::optional<PoseSolution> seenFrom(int other, int index) const;
  /// Keyframe b as found from keyframe a, and how far from there it would fit as well.
  RelativePose loopBetween(int a, int b, const PoseSolution& seen) const;
  /// How far from where a view was found, with so many inliers, keyframes near that place find it as well: what floors and doors show
  /// repeats itself. Infinity: nowhere.
  double nearestRival_m(int place, const Sighting& view, const Pose3& place_from_view, int inliers) const;
  /// Keyframes near a place, but not at it, that look most like the view.
  std::vector<int> similarBeside(int place, const Sighting& view) const;
  /// Keyframes nearest in time within the horizon, nearest first; for those that were given up, the ones that show the same.
  std::vector<int> keyframesNear(double t) const;
  RelativePose loopOf(int keyframe, double t, const Pose3& keyframe_from_camera,
                      const Matrix6d& covariance) const;
  /// Whether a robot would have left its floor, or tilted, to see this from the keyframe's place.
  bool offFloor(const Pose3& keyframe_from_camera) const;
  Matrix6d stepCovariance(const Pose3& previous_from_current, const PoseSolution& solution);
  Pose3 lastPose() const;

  struct Velocity {
    Pose3 step = Pose3::Identity();  ///< previous_from_current
    double seconds = 0;              ///< that it took
  };
  /// Where the last velocity leads in the time since the last frame; nothing known: it stands.
  Pose3 goesOn() const;

  TrackingParameters parameters_;
  Foreseen<Sight> foreseen_;
  LocalMap map_;
  std::vector<Record> records_;
  Record placed_{};  ///< the last one that features placed
  std::vector<RelativePose> closures_;
  Box2 mover_;                               ///< what moved before the camera, px,
  double mover_t_ = -1e300;                  ///< when it was seen last
  std::vector<std::int64_t> last_points_;    ///< inliers of the last tracked frame
  std::optional<Velocity> velocity_;         ///< of the last step
  double step_s_ = 0;                        ///< from the frame before to the one being tracked
  double reckoned_t_ = -1e300;               ///< of the last frame, usable or not
  /// Movement since the last frame that features placed, as far as is known: now, and one frame before.
  Pose3 dead_reckoned_ = Pose3::Identity(), dead_reckoned_before_ = Pose3::Identity();
  std::optional<Pose3> measured_ = Pose3::Identity();  ///< the same as other sensors saw it; nothing when they missed a part
  DenseChain dense_;                         ///< since that frame
  bool densely_placed_ = false;              ///< the frame being tracked
  MovementHabits habits_;
  std::optional<Pose3> robot_from_camera_;   ///< of the last frame; nothing: handheld
  std::optional<StampedPose> habit_from_;    ///< odom_from_camera of the frame since when a movement is learnt
  Matrix6d last_covariance_ = Matrix6d::Zero();
  int segment_ = 0;  ///< that of the last record
  int lost_frames_ = 0;   ///< since features placed one
  int blind_frames_ = 0;  ///< since anything placed one
  bool carried_ = false;  ///< there was a pause of which nobody tells how the camera moved, and nothing placed it since
  int reference_ = -1;         ///< keyframe that holds the frames tracked now
  int reference_inliers_ = 0;  ///< of the first frame after it, 0: not seen yet
  int last_loop_ = -1000;
  int examined_ = 0;  ///< keyframes that were looked at whether they repeat older ones
  int given_up_ = 0;  ///< of them
  double last_t_ = -1e300;
  ResultStore* results_ = nullptr;
  bool keeps_view_ = false;  ///< of the frame being tracked nothing was kept so far
};

}  // namespace roomgraph::tracking
