// SPDX-License-Identifier: BSD-3-Clause
// MapAnchor: each source alone finds the place; another building and a symmetric room are refused.
#include "roomgraph/estimation/map_anchor.h"

#include <gtest/gtest.h>

#include "roomgraph/mapping/occupancy_mapper.h"
#include "synthetic_scans.h"
#include "textured_room.h"

namespace roomgraph::test {
namespace {

constexpr double kEnd_s = 12;

// In the frame of the map; the run's own frame is its first pose.
Pose2 onTheWay(double t) {
  return {-1.5 + 0.25 * t, -0.5 + 0.06 * t, 0.9 - 0.1 * t};
}

std::vector<Wall> rectangle() {
  return ring({{-4, -2}, {4, -2}, {4, 2}, {-4, 2}});
}

mrpt::maps::COccupancyGridMap2D::Ptr gridOf(const std::vector<Wall>& walls) {
  OccupancyMapper mapper;
  Trajectory way;
  std::mt19937 random(5);
  for (int i = 0; i <= 60; ++i) {
    const double t = 0.2 * i;
    way.add(t, toPose3(onTheWay(t)));
    mapper.add(castScan(walls, onTheWay(t), t, random));
  }
  return mapper.build(way);
}

Landmark seat(std::int64_t id, double x, double y) {
  Landmark landmark;
  landmark.id = LandmarkId{id};
  landmark.class_name = "chair";
  landmark.shape = {ShapeKind::kCylinder, 0.6, 0.6, 0.9};
  landmark.position = {x, y, 0};
  return landmark;
}

const std::vector<Landmark>& seats() {
  static const std::vector<Landmark> all = {seat(0, 0, 0), seat(1, 3, 0.5), seat(2, 1, -1.5), seat(3, -2, 1)};
  return all;
}

/// A drive along the way: what the sources tell is given by the test.
struct OwnRun {
  MotionSource none{MotionNoise{}, true};
  Motion motion{none, none, none};
  KeyPoses poses{motion};
  std::mt19937 random{8};
  Pose2 own_from_map = onTheWay(0).inverse();

  std::vector<Landmark> seen() const {
    std::vector<Landmark> out = seats();
    for (auto& landmark : out)
      landmark.position.head<2>() = own_from_map * Eigen::Vector2d(landmark.position.head<2>());
    return out;
  }
  /// map_from_world, and when; nothing when it was not found.
  std::optional<Pose2> drive(MapAnchor& anchor, const std::vector<Wall>* walls, bool objects,
                             const TexturedRoom* room = nullptr) {
    for (int i = 0; i * 0.3 < kEnd_s; ++i) {
      const double t = 0.3 * i;
      poses.add(t, toPose3(own_from_map * onTheWay(t)));
      if (walls) anchor.add(castScan(*walls, onTheWay(t), t, random), poses);
      if (room) anchor.add(frameOf(*room, t), {}, poses);
      const auto found = anchor.recognise(objects ? seen() : std::vector<Landmark>(), poses, true);
      if (found) return planarPart(*found);
    }
    return std::nullopt;
  }
  static Pose3 robotFromCamera() {
    Pose3 pose = Pose3::Identity();
    pose.linear() = bodyFromOptical();
    return pose;
  }
  // The room of the images has y downwards; a robot drives on its x-z plane.
  static Frame frameOf(const TexturedRoom& room, double t) {
    const Pose3 map_from_camera = toPose3(onTheWay(t)) * robotFromCamera();
    Pose3 room_from_map = Pose3::Identity();
    room_from_map.linear() << 1, 0, 0, 0, 0, -1, 0, 1, 0;
    Frame frame = room.render(t, room_from_map * map_from_camera);
    frame.robot_from_camera = robotFromCamera();
    return frame;
  }
};

void expectTrue(const std::optional<Pose2>& found, double tolerance_m) {
  ASSERT_TRUE(found);
  const Pose2 error = onTheWay(0).inverse() * *found;
  EXPECT_LT(std::hypot(error.x, error.y), tolerance_m);
  EXPECT_LT(std::abs(error.yaw), 0.03);
}

TEST(MapAnchor, ScansAloneFindThePlace) {
  const auto walls = asymmetricRoom();
  CSemanticMap map;
  map.occupancy = gridOf(walls);
  MapAnchor anchor(map, {}, {});
  OwnRun run;
  expectTrue(run.drive(anchor, &walls, false), 0.05);
  ASSERT_TRUE(anchor.anchoring());
  EXPECT_EQ(anchor.anchoring()->sources, std::vector{PlaceSource::kScans});
  EXPECT_GE(anchor.anchoring()->t, 3) << "one source must agree for some time";
  EXPECT_FALSE(anchor.recognise({}, run.poses, true)) << "a map is recognised once";
}

// There and back, for as long as it takes.
Pose2 toAndFro(double t) {
  const double phase = std::fmod(t, 2 * kEnd_s);
  return onTheWay(std::min(phase, 2 * kEnd_s - phase));
}

TEST(MapAnchor, WhoComesLateIsRecognised) {
  constexpr double kElsewhere_s = 240, kStep_s = 0.5;
  const auto walls = asymmetricRoom(), other = rectangle();
  CSemanticMap map;
  map.occupancy = gridOf(walls);
  MapAnchor anchor(map, {}, {});
  OwnRun run;
  std::optional<double> found_s;
  for (double t = 0; t < kElsewhere_s + 40 && !found_s; t += kStep_s) {
    const bool there = t > kElsewhere_s;
    const Pose2 place = there ? toAndFro(t - kElsewhere_s) : onTheWay(0);
    run.poses.add(t, toPose3(run.own_from_map * place));
    anchor.add(castScan(there ? walls : other, place, t, run.random), run.poses);
    if (anchor.recognise({}, run.poses, true)) found_s = t - kElsewhere_s;
  }
  ASSERT_TRUE(found_s);
  EXPECT_GT(*found_s, 0);
  EXPECT_LT(*found_s, 25);
}

// The lidar stops: its last scan tells once where the robot was.
TEST(MapAnchor, AScanGivesOneFix) {
  const auto walls = asymmetricRoom();
  CSemanticMap map;
  map.occupancy = gridOf(walls);
  MapAnchor anchor(map, {}, {});
  OwnRun run;
  const auto found = run.drive(anchor, &walls, false);
  ASSERT_TRUE(found);
  const double last = run.poses.nodes().back().t;
  run.poses.moveFrom(run.poses.nodes().front().id, toPose3(*found));
  std::vector<double> fixes;
  for (double t = last; t < last + 20; t += 0.5) {
    if (t > last) run.poses.add(t, toPose3(toAndFro(t)));
    if (const auto fix = anchor.fix(run.poses)) fixes.push_back(fix->t);
  }
  EXPECT_EQ(fixes, std::vector{last});
}

TEST(MapAnchor, ASymmetricRoomAndAnotherOneAreRefused) {
  const auto walls = rectangle(), other = asymmetricRoom();
  CSemanticMap map;
  map.occupancy = gridOf(walls);
  MapAnchor symmetric(map, {}, {}), foreign(map, {}, {});
  EXPECT_FALSE(OwnRun().drive(symmetric, &walls, false)) << "two places look the same";
  EXPECT_FALSE(OwnRun().drive(foreign, &other, false));
  EXPECT_FALSE(foreign.anchoring());
}

TEST(MapAnchor, ObjectsAloneFindThePlaceButNotAgainstTheWalls) {
  CSemanticMap map;
  map.landmarks = seats();
  MapAnchor objects(map, {}, {});
  expectTrue(OwnRun().drive(objects, nullptr, true), 1e-6);
  map.occupancy = gridOf(rectangle());
  const auto other = asymmetricRoom(), walls = rectangle();
  MapAnchor contradicted(map, {}, {}), confirmed(map, {}, {});
  EXPECT_FALSE(OwnRun().drive(contradicted, &other, true)) << "the walls are others";
  expectTrue(OwnRun().drive(confirmed, &walls, true), 0.05);
  map.landmarks.pop_back();
  map.occupancy.reset();
  MapAnchor few(map, {}, {});
  EXPECT_FALSE(OwnRun().drive(few, nullptr, true)) << "three objects are too few without walls";
}

TEST(MapAnchor, ImagesAloneFindThePlace) {
  const TexturedRoom room, other(2);
  CSemanticMap map;
  for (int i = 0; i <= 10; ++i) {
    KeyView view = makeKeyView(OwnRun::frameOf(room, 1.1 * i), {}, 200);
    view.world_from_camera = toPose3(onTheWay(1.1 * i)) * OwnRun::robotFromCamera();
    map.views.push_back(view);
  }
  MapAnchor anchor(map, {}, {}), foreign(map, {}, {});
  expectTrue(OwnRun().drive(anchor, nullptr, false, &room), 0.05);
  EXPECT_EQ(anchor.anchoring()->sources, std::vector{PlaceSource::kImages});
  EXPECT_FALSE(OwnRun().drive(foreign, nullptr, false, &other));
}

TEST(PlaceConsensus, RivalsHoldItBackAndTwoSourcesAreQuicker) {
  OwnRun run;
  for (int i = 0; i <= 40; ++i) run.poses.add(0.3 * i, toPose3(run.own_from_map * onTheWay(0.3 * i)));
  const auto at = [](PlaceSource source, double t, double off) {
    return PlaceSighting{source, t, toPose3(Pose2{off, 0, 0} * onTheWay(t))};
  };
  PlaceConsensus two({}), disputed({});
  two.add(at(PlaceSource::kScans, 0, 0));
  two.add(at(PlaceSource::kImages, 0.3, 0.05));
  EXPECT_FALSE(two.confirmed(run.poses)) << "two sightings only";
  two.add(at(PlaceSource::kImages, 0.6, 0));
  ASSERT_TRUE(two.confirmed(run.poses));
  EXPECT_EQ(two.confirmed(run.poses)->sightings, 3);
  for (int i = 0; i < 8; ++i) {
    disputed.add(at(i % 2 ? PlaceSource::kScans : PlaceSource::kImages, i, i % 3 ? 0 : 4));
    EXPECT_FALSE(disputed.confirmed(run.poses)) << i;
  }
}

}  // namespace
}  // namespace roomgraph::test
