// SPDX-License-Identifier: BSD-3-Clause
// Training sets: files, boxes against the picture of objects, repetition, refusals.
#include "roomgraph/simulation/training_set.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>
#include <opencv2/core.hpp>
#include <sstream>

#include "errors_of.h"
#include "roomgraph/core/errors.h"
#include "roomgraph/geometry/pose.h"
#include "roomgraph/observations/rgbd_channels.h"
#include "roomgraph/simulation/flat.h"
#include "scene.h"
#include "sitting.h"
#include "temporary_folder.h"
#include "training_world.h"

namespace roomgraph {
namespace {

std::string contentOf(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream out;
  out << stream.rdbuf();
  return out.str();
}

TrainingSetOptions twoViews() {
  TrainingSetOptions out;
  out.first_flat = out.last_flat = 7;
  out.views = 4;
  out.size = {128, 96};
  return out;
}

TEST(TrainingSetTest, WritesViewsWithTheirBoxesAndRepeats) {
  const test::TemporaryFolder folder;
  const auto result = writeTrainingSet(twoViews(), folder.path() / "a");
  ASSERT_GT(result.views, 0);
  EXPECT_EQ(result.flats, 1);
  const std::string pixels = contentOf(folder.path() / "a" / "views.u8");
  EXPECT_EQ(pixels.size(), static_cast<std::size_t>(result.views) * kRgbdChannels * 128 * 96);
  std::istringstream lines(contentOf(folder.path() / "a" / "views.jsonl"));
  int views = 0, boxes = 0, placed = 0;
  for (std::string line; std::getline(lines, line); ++views) {
    const auto label = nlohmann::json::parse(line);
    EXPECT_EQ(label["flat"], 7);
    for (const auto& box : label["boxes"]) {
      ++boxes;
      EXPECT_GE(box["box"][0], 0);
      EXPECT_LT(box["box"][0], box["box"][2]);
      EXPECT_LT(box["box"][1], box["box"][3]);
      EXPECT_LE(box["box"][2], 128);
      EXPECT_LE(box["box"][3], 96);
      EXPECT_GT(box["visible"], 0);
      EXPECT_LE(box["visible"], 1);
      if (!box.contains("range")) continue;
      ++placed;
      EXPECT_GT(box["range"].get<double>(), box["depth"].get<double>() - 2)
          << "no piece of furniture is larger";
      EXPECT_LE(std::abs(box["front"].get<double>()), std::numbers::pi + 1e-3);
    }
  }
  EXPECT_EQ(views, result.views);
  EXPECT_EQ(boxes, result.boxes);
  EXPECT_GT(placed, 0);
  const auto about = nlohmann::json::parse(contentOf(folder.path() / "a" / "set.json"));
  EXPECT_EQ(about["views"], views);
  EXPECT_EQ(about["height"], 96);

  writeTrainingSet(twoViews(), folder.path() / "b");
  for (const char* name : {"views.u8", "views.jsonl", "set.json"})
    EXPECT_EQ(contentOf(folder.path() / "a" / name), contentOf(folder.path() / "b" / name)) << name;
}

TEST(TrainingSetTest, PlacesAreWhereTheCameraSeesThem) {
  const Eigen::Vector3d camera(1, 1, 1.2);
  const double quarter = std::numbers::pi / 2;
  // 4 m ahead along x, its middle .9 m lower.
  const SeenPlace facing = seenPlace(poseFromYpr(5, 1, 0, 2 * quarter, 0, 0), 0.6, camera);
  EXPECT_NEAR(facing.range_m, std::hypot(4, 0.9), 1e-12);
  EXPECT_NEAR(facing.front_rad, 0, 1e-12);
  EXPECT_NEAR(std::abs(seenPlace(poseFromYpr(5, 1, 0, 0, 0, 0), 0.6, camera).front_rad), 2 * quarter, 1e-12);
  // Counter-clockwise from above: a front along y, seen by a camera on the negative x side of it, is turned
  // to its right.
  EXPECT_NEAR(seenPlace(poseFromYpr(5, 1, 0, quarter, 0, 0), 0.6, camera).front_rad, -quarter, 1e-12);
  EXPECT_NEAR(seenPlace(poseFromYpr(1, 4, 0, 2 * quarter, 0, 0), 0.6, camera).front_rad, -quarter, 1e-12)
      << "as before, all turned by 90 degrees";
}

TEST(TrainingSetTest, FlatsForReportingAreRefused) {
  const test::TemporaryFolder folder;
  auto options = twoViews();
  options.first_flat = 990;
  options.last_flat = 1000;
  EXPECT_THROW(writeTrainingSet(options, folder.path()), ConfigError);
  options.first_flat = options.last_flat = 1019;
  EXPECT_THROW(writeTrainingSet(options, folder.path()), ConfigError);
  options.first_flat = 5;
  options.last_flat = 4;
  EXPECT_THROW(writeTrainingSet(options, folder.path()), ConfigError);
}

TEST(TrainingSetTest, ChoiceOfMeshesNamesWhatIsWrong) {
  const test::TemporaryFolder folder;
  const auto file = folder.path() / "choice.json";
  const auto choose = [&](const std::string& text) {
    std::ofstream(file) << text;
    return readMeshChoice(file, folder.path());
  };
  std::ofstream(folder.path() / "a.obj") << "x";
  const auto read = choose(R"({"sofa": ["a.obj"], "person": []})");
  EXPECT_EQ(read.at("sofa").front(), folder.path() / "a.obj");
  EXPECT_NE(test::messageOf<ConfigError>([&] { choose(R"({"sofer": []})"); }).find("unknown kind 'sofer'"),
            std::string::npos);
  EXPECT_NE(
      test::messageOf<ConfigError>([&] { choose(R"({"sofa": ["b.obj"]})"); }).find("b.obj is not there"),
      std::string::npos);
  EXPECT_THROW(choose("[1, 2"), InputError);
  EXPECT_THROW(choose(R"({"sofa": [3]})"), InputError);
  EXPECT_THROW(readMeshChoice(folder.path() / "none.json", folder.path()), InputError);
}

TEST(TrainingSetTest, StopsWhenInterrupted) {
  const test::TemporaryFolder folder;
  auto options = twoViews();
  options.last_flat = 9;
  options.interrupted = [] { return true; };
  const auto result = writeTrainingSet(options, folder.path());
  EXPECT_TRUE(result.interrupted);
  EXPECT_EQ(result.flats, 1);
  EXPECT_LE(result.views, 1) << "at once, rather than after the flat";
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "set.json"));
}

TEST(TrainingWorldTest, PeopleAndChairsAreAddedInTheRooms) {
  std::size_t sitting = 0, standing = 0, chairs = 0;
  for (std::uint64_t flat = 1; flat <= 5; ++flat) {
    const World plain = randomFlat({flat, 0, false, {}});
    World varied = plain;
    Random random(flat);
    varyWorld(varied, {}, random);
    const auto isIndoors = [&](const Eigen::Vector2d& at) {
      return std::ranges::any_of(varied.rooms, [&](const Room& room) {
        return (at.array() > room.min_m.array()).all() && (at.array() < room.max_m.array()).all();
      });
    };
    for (std::size_t i = plain.people.size(); i < varied.people.size(); ++i) {
      for (const auto& at : varied.people[i].path_m)
        EXPECT_TRUE(isIndoors(at)) << "flat " << flat << " person " << i;
      ++(varied.people[i].sits ? sitting : standing);
    }
    for (std::size_t i = plain.furniture.size(); i < varied.furniture.size(); ++i, ++chairs)
      EXPECT_TRUE(isIndoors(varied.furniture[i].at_m.head<2>())) << "flat " << flat << " chair " << i;
  }
  EXPECT_GT(sitting, 5u);
  EXPECT_GT(standing, 5u);
  EXPECT_GT(chairs, 5u);
}

TEST(TrainingWorldTest, OneViewInThreeIsOfAnObjectCloseBy) {
  const Scene scene(randomFlat({7, 0, false, {}}));
  Random random(1);
  int close = 0;
  for (int i = 0; i < 300; ++i) {
    const double seconds = random.uniform(0, scene.duration());
    const Pose3 camera = drawTrainingView(scene, seconds, random);
    const Eigen::Vector3d at = camera.translation(), ahead = camera.linear().col(2);
    EXPECT_GE(at.z(), 0.25);
    EXPECT_LE(at.z(), 1.8);
    if ((at - scene.worldFromRobot(seconds).translation()).head<2>().norm() < 0.25)
      continue;  // from the path
    ++close;
    EXPECT_TRUE(std::ranges::any_of(
        scene.objects(),
        [&](const SceneObject& object) {
          const Eigen::Vector2d to = (object.world_from_object.translation() - at).head<2>();
          const double beside =
              std::abs(wrapAngle(std::atan2(to.y(), to.x()) - std::atan2(ahead.y(), ahead.x())));
          return to.norm() > 0.79 && to.norm() < 2.21 && beside < 0.51;
        }))
        << "view " << i;
  }
  EXPECT_GT(close, 60);
  EXPECT_LT(close, 150);
}

TEST(Sitting, OnWhatIsASeatAndWhereItsFrontIs) {
  Furniture sofa;
  sofa.model = "sofa";
  sofa.at_m = {2, 1, 0};
  sofa.yaw_rad = std::numbers::pi / 2;
  const Pose2 at = placeOnSeat(sofa, 0.3);
  EXPECT_NEAR(at.x, 1.7, 1e-9) << "to the left of who looks along y";
  EXPECT_NEAR(at.y, 1.06, 1e-9) << "before the middle, as the back takes room";
  EXPECT_NEAR(at.yaw, sofa.yaw_rad, 1e-9);
  Furniture stool;
  stool.model = "stool";
  stool.size_m = {0.4, 0.4, 0.55};
  EXPECT_EQ(seatHeight(stool), 0.55);
  EXPECT_LT(*seatHeight(sofa), 0.5);
  Furniture shelf;
  shelf.model = "shelf";
  EXPECT_FALSE(seatHeight(shelf));
}

TEST(TrainingWorldTest, SpoiledDepthLosesAndNeverInvents) {
  cv::Mat object(96, 128, CV_16S, cv::Scalar(-1));
  object(cv::Rect(20, 20, 40, 40)).setTo(3);
  int changed = 0;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    cv::Mat depth(96, 128, CV_16U, cv::Scalar(2000));
    Random random(seed);
    spoilDepth(depth, object, random);
    for (const std::uint16_t z : cv::Mat_<std::uint16_t>(depth))
      EXPECT_TRUE(z == 0 || (z > 1930 && z < 2070)) << z;
    if (cv::countNonZero(depth == 2000) < 96 * 128) ++changed;
  }
  EXPECT_GT(changed, 15);
  EXPECT_LT(changed, 40);
}

}  // namespace
}  // namespace roomgraph
