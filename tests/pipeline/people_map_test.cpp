// SPDX-License-Identifier: BSD-3-Clause
// A person who sits in a robot's view for minutes, all the way: scan matcher, grid and landmarks.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "drive.h"
#include "fake_stages.h"

// A scan matcher that keeps what it is given; the robot stands.
namespace fakes {

class WatchingMatcher : public roomgraph::ScanMatcher {
  DEFINE_MRPT_OBJECT(WatchingMatcher, fakes)
 public:
  static inline std::vector<roomgraph::Scan> scans;

  roomgraph::ScanMatch match(const roomgraph::Scan& scan, const std::optional<roomgraph::Pose2>&) override {
    scans.push_back(scan);
    trajectory_.add(scan.t, roomgraph::Pose3::Identity());
    return {.matched = true, .step_covariance = 1e-6 * Eigen::Matrix3d::Identity(), .score = 1};
  }
  roomgraph::Trajectory trajectory() const override { return trajectory_; }

 private:
  roomgraph::Trajectory trajectory_;
};

IMPLEMENTS_MRPT_OBJECT(WatchingMatcher, roomgraph::ScanMatcher, fakes)

}  // namespace fakes

namespace roomgraph::test {
namespace {

using Grid = mrpt::maps::COccupancyGridMap2D;

const Eigen::Vector2d kSeat(2, 0.3);
constexpr double kSitsDown_s = 6, kEnd_s = 150;

// A cylinder as large as a person.
fakes::WorldObject personAt(const Eigen::Vector2d& place) {
  return {"person", {ShapeKind::kCylinder, 0.5, 0.5, 1.7}, poseFromYpr(place.x(), place.y(), 0, 0, 0, 0)};
}

// Two minutes and a half before a room with one chair in it; the person comes after six seconds and stays.
SlamResult standBeforeTheSeat(bool with_person) {
  registerAllClasses();
  fakes::registerClasses();
  mrpt::rtti::registerClass(CLASS_ID_NAMESPACE(WatchingMatcher, fakes));
  fakes::WatchingMatcher::scans.clear();
  fakes::world() = {};
  fakes::world().world_from_camera = [](double) { return Drive::robotFromCamera(); };
  const fakes::WorldObject chair{"swivel_chair", {ShapeKind::kCylinder, 0.6, 0.6, 0.9}, poseFromYpr(3, -1, 0, 0, 0, 0)};
  const fakes::WorldObject person = personAt(kSeat);
  SemanticSlam slam(setupWith("[detection]\nclass = FakeDetector\n[proposals]\nclass = FakeProposals\n[tracking]\n"
                              "enabled = false\n[lidar]\nclass = WatchingMatcher\nloop_closing = false\n"));
  std::mt19937 random{3};
  for (double t = 0; t < kEnd_s; t += 0.5) {
    const bool sits = with_person && t >= kSitsDown_s;
    fakes::world().objects = {chair};
    auto walls = asymmetricRoom();
    if (sits) {
      fakes::world().objects.push_back(person);
      for (const Wall& side : boxAt(kSeat.x() - 0.2, kSeat.y() - 0.2, 0.4, 0.4)) walls.push_back(side);
    }
    slam.process(Drive::frame(t));
    slam.process(castScan(walls, {}, t + 0.1, random, 0.01, 720));
  }
  return slam.finish();
}

bool occupiedWithin(const Grid& grid, const Eigen::Vector2d& place, double reach_m) {
  for (int x = 0; x < static_cast<int>(grid.getSizeX()); ++x)
    for (int y = 0; y < static_cast<int>(grid.getSizeY()); ++y) {
      const Eigen::Vector2d cell(grid.idx2x(x), grid.idx2y(y));
      if ((cell - place).norm() <= reach_m && grid.getCell(x, y) < 0.4F) return true;  // cells say how free they are
    }
  return false;
}

TEST(PeopleMap, ASittingPersonIsNotDrawnAndErasesNothing) {
  const SlamResult alone = standBeforeTheSeat(false);
  ASSERT_TRUE(alone.map.occupancy);
  const Grid before = *alone.map.occupancy;
  EXPECT_EQ(alone.counts.returns_on_people, 0);
  const SlamResult together = standBeforeTheSeat(true);
  ASSERT_TRUE(together.map.occupancy);
  const Grid& after = *together.map.occupancy;
  EXPECT_GT(together.counts.returns_on_people, 1000);
  EXPECT_FALSE(occupiedWithin(after, kSeat, 0.35)) << "the person is drawn into the map";

  int walls = 0, erased = 0;
  for (int x = 0; x < static_cast<int>(before.getSizeX()); ++x)
    for (int y = 0; y < static_cast<int>(before.getSizeY()); ++y) {
      if (before.getCell(x, y) > 0.3F) continue;
      ++walls;
      erased += !occupiedWithin(after, {before.idx2x(x), before.idx2y(y)}, 0.08);
    }
  EXPECT_GT(walls, 200);
  EXPECT_EQ(erased, 0) << "of the walls behind the seat, among others";

  ASSERT_EQ(together.map.landmarks.size(), 1u) << "the chair";
  ASSERT_EQ(alone.map.landmarks.size(), 1u);
  EXPECT_GT(together.map.landmarks[0].existence, alone.map.landmarks[0].existence - 0.01);
  for (const Scan& scan : fakes::WatchingMatcher::scans) {
    if (scan.t < kSitsDown_s) continue;
    for (const auto& point : scan.pointsInRobot())
      ASSERT_GT((point.head<2>() - kSeat).norm(), 0.4) << "the scan matcher saw the person at " << scan.t;
  }
}

// A depth image of a wall 3.5 m ahead and somebody before it.
Frame depthOf(const fakes::WorldObject& person) {
  Frame frame = Drive::frame(0);
  frame.depth.setTo(3.5F);
  const Pose3 camera_from_person = Drive::robotFromCamera().inverse() * person.world_from_object;
  const Box2 seen = projectShape(person.shape, camera_from_person, frame.camera)->visible;
  frame
      .depth(cv::Rect(cv::Point(static_cast<int>(seen.u_min) + 1, static_cast<int>(seen.v_min) + 1),
                      cv::Point(static_cast<int>(seen.u_max), static_cast<int>(seen.v_max))))
      .setTo(1.8F);
  return frame;
}

// At whom the detector looks or not.
Grid gridFromDepth(bool detected) {
  registerAllClasses();
  fakes::registerClasses();
  mrpt::rtti::registerClass(CLASS_ID_NAMESPACE(WatchingMatcher, fakes));
  fakes::world() = {};
  fakes::world().world_from_camera = [](double) { return Drive::robotFromCamera(); };
  const fakes::WorldObject person = personAt(kSeat);
  if (detected) fakes::world().objects = {person};
  Frame frame = depthOf(person);
  SemanticSlam slam(
      setupWith("[detection]\nclass = FakeDetector\n[proposals]\nclass = FakeProposals\n[tracking]\n"
                "enabled = false\n[lidar]\nclass = WatchingMatcher\nloop_closing = false\n"
                "[mapping]\nsource = depth\n"));
  std::mt19937 random{3};
  for (double t = 0; t < 10; t += 0.5) {
    frame.t = t;
    frame.id = FrameId{static_cast<std::int64_t>(std::lround(10 * t))};
    slam.process(frame);
    slam.process(castScan(asymmetricRoom(), {}, t + 0.1, random, 0.01, 720));
  }
  return *slam.finish().map.occupancy;
}

TEST(PeopleMap, DepthImagesLeavePeopleOut) {
  const Eigen::Vector2d wall(3.6, -0.8), front(1.9, kSeat.y());
  const Grid drawn = gridFromDepth(false), left_out = gridFromDepth(true);
  EXPECT_TRUE(occupiedWithin(drawn, front, 0.15)) << "what nobody calls a person is an obstacle";
  EXPECT_FALSE(occupiedWithin(left_out, front, 0.4));
  EXPECT_TRUE(occupiedWithin(drawn, wall, 0.1));
  EXPECT_TRUE(occupiedWithin(left_out, wall, 0.1));
}

// Somebody whom no detector knows comes before a robot that stands and has looked for three seconds, walks, and stands for three more.
SlamResult walkPastACamera(const std::string& mapping_keys) {
  registerAllClasses();
  mrpt::rtti::registerClass(CLASS_ID_NAMESPACE(WatchingMatcher, fakes));
  SemanticSlam slam(setupWith("[detection]\nenabled = false\n[tracking]\nenabled = false\n[lidar]\nclass = WatchingMatcher\n"
                              "loop_closing = false\n[mapping]\n" + mapping_keys));
  std::mt19937 random{3};
  for (int i = 0; i < 80; ++i) {
    const double t = 0.1 * i, walked_m = std::clamp(0.65 * (t - 3), 0., 1.3);
    Frame frame = depthOf(personAt({2, t < 3 ? -50 : walked_m - 1}));
    if (t < 3) frame.depth.setTo(3.5F);
    frame.t = t;
    frame.id = FrameId{i};
    slam.process(frame);
    slam.process(castScan(asymmetricRoom(), {}, t + 0.05, random, 0.01, 720));
  }
  return slam.finish();
}

TEST(PeopleMap, WhoeverWalksThroughDepthImagesLeavesNoTrace) {
  const SlamResult with = walkPastACamera("source = depth\nmax_wait_s = 0.05\n"),
                   without = walkPastACamera("source = depth\nmax_wait_s = 0.05\nleave_out_moving = false\n");
  ASSERT_TRUE(with.map.occupancy && without.map.occupancy);
  EXPECT_EQ(without.counts.returns_in_free_space, 0);
  EXPECT_GT(with.counts.returns_in_free_space, 500);
  const Eigen::Vector2d end(1.9, 0.3);
  EXPECT_TRUE(occupiedWithin(*without.map.occupancy, end, 0.2)) << "else the test shows nothing";
  EXPECT_FALSE(occupiedWithin(*with.map.occupancy, end, 0.4));
  EXPECT_TRUE(occupiedWithin(*with.map.occupancy, {3.6, -0.8}, 0.1)) << "the wall stays";
  EXPECT_EQ(walkPastACamera("").counts.returns_in_free_space, 0) << "the grid is of scans";
}

constexpr double kFollowsFrom_s = 4, kStops_s = 8.5;

// Somebody goes after the robot on its lap, a metre behind its back, where no camera looks, and stops in the
// end.
Eigen::Vector2d follower(double t) {
  const Pose2 place = Drive::truth(std::min(t, kStops_s) - 2);
  return {place.x, place.y};
}

SlamResult lapWithFollower(const std::string& lidar_keys) {
  registerAllClasses();
  SemanticSlam slam(
      setupWith("[tracking]\nenabled = false\n[detection]\nenabled = false\n[lidar]\n" + lidar_keys));
  Drive drive;
  for (int i = 0; i < 120; ++i) {
    const double t = 0.1 * i;
    auto walls = asymmetricRoom();
    if (t > kFollowsFrom_s)
      for (const Wall& side : boxAt(follower(t).x() - 0.15, follower(t).y() - 0.15, 0.3, 0.3))
        walls.push_back(side);
    slam.process(drive.odometry(t));
    slam.process(castScan(walls, Drive::truth(t), t + 0.001, drive.random, 0.01, 720));
  }
  return slam.finish();
}

TEST(PeopleMap, WhoeverFollowsTheRobotLeavesNoTrace) {
  const SlamResult with = lapWithFollower("");
  const SlamResult without = lapWithFollower("leave_out_moving = false\n");
  ASSERT_TRUE(with.map.occupancy && without.map.occupancy);
  EXPECT_GT(without.counts.scans, 100);
  EXPECT_EQ(without.counts.returns_in_free_space, 0);
  EXPECT_TRUE(occupiedWithin(*without.map.occupancy, follower(Drive::kLap_s), 0.2))
      << "else the test shows nothing";
  EXPECT_GT(with.counts.returns_in_free_space, 500);
  for (double t = kFollowsFrom_s; t < kStops_s; t += 0.1)
    EXPECT_FALSE(occupiedWithin(*with.map.occupancy, follower(t), 0.35)) << t;
  EXPECT_EQ(with.counts.returns_on_people, 0) << "no image showed anybody";
  EXPECT_TRUE(occupiedWithin(*with.map.occupancy, {5, 0}, 0.1)) << "the walls stay";
}

}  // namespace
}  // namespace roomgraph::test
