// SPDX-License-Identifier: BSD-3-Clause
// Which measurement comes from which model, instant and stream: a recording without noise against its scene.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <opencv2/core.hpp>

#include "example_world.h"
#include "roomgraph/datasets/rawlog_reader.h"
#include "roomgraph/simulation/simulate.h"
#include "scene.h"
#include "sensors.h"
#include "temporary_folder.h"

namespace roomgraph {
namespace {

constexpr double kFirstInstant = 1700000000;

/// The example, driven for a second from the middle of its path on, without any noise.
World exactWorld() {
  World world = test::exampleWorld();
  world.duration_s = 1.0;
  world.camera->noise_gain = 0;
  world.camera->rate_hz = 2;
  world.camera->pitch_down_rad = 0.25;
  world.lidar->sigma_m = world.lidar->sigma_relative = world.lidar->dropouts = 0;
  world.lidar->rate_hz = 4;
  world.lidar->at_m = {0.12, -0.07, 0.3};
  world.odometry = OdometrySpec{10, 0, 0, 0, 0, 0, 0, 0, 0};
  world.robot->acceleration_m_s2 = 2;
  return world;
}

struct Recorded {
  test::TemporaryFolder folder;
  World world = exactWorld();
  Scene scene{world};
  std::vector<Frame> frames;
  std::vector<Scan> scans;
  std::vector<OdometryReading> readings;

  Recorded() {
    RawlogReader reader(simulate(world, folder.path(), {}).rawlog);
    while (const auto record = reader.next()) {
      if (const auto* frame = std::get_if<Frame>(&*record)) frames.push_back(*frame);
      if (const auto* scan = std::get_if<Scan>(&*record)) scans.push_back(*scan);
      if (const auto* reading = std::get_if<OdometryReading>(&*record)) readings.push_back(*reading);
    }
  }
};

TEST(SimulateWiring, ScansAreThoseOfTheMountedLidarAtTheirInstants) {
  const Recorded r;
  ASSERT_EQ(r.scans.size(), 4u);  // at 0.03, 0.28, 0.53 and 0.78 s
  const LidarCaster caster(r.scene, 0.3);
  for (std::size_t i = 0; i < r.scans.size(); ++i) {
    const Scan& scan = r.scans[i];
    const double t = scan.t - kFirstInstant;
    EXPECT_NEAR(t, 0.25 * static_cast<double>(i) + 0.03, 1e-6);
    EXPECT_LT((scan.robot_from_lidar.translation() - r.world.lidar->at_m).norm(), 1e-6);
    const auto expected = caster.cast(planarPart(r.scene.worldFromRobot(t)) * Pose2{0.12, -0.07, 0}, 360, t);
    for (std::size_t k = 0; k < expected.size(); ++k) {
      ASSERT_TRUE(scan.valid[k]) << k;
      EXPECT_NEAR(scan.ranges_m[k], expected[k], 2e-5) << k;
    }
    EXPECT_NEAR(scan.angle_min_rad, -3.14159265, 1e-5);
    EXPECT_NEAR(scan.angle_step_rad, 2 * 3.14159265 / 359, 1e-6);
  }
}

TEST(SimulateWiring, DepthIsTheExactPictureAtItsInstantInMillimetres) {
  const Recorded r;
  ASSERT_EQ(r.frames.size(), 3u);
  for (const auto& frame : r.frames) {
    const double t = frame.t - kFirstInstant;
    const IdImage exact =
        rasterize(r.scene, r.scene.partPoses(t), r.scene.worldFromCamera(t), r.world.camera->model);
    double worst = 0;
    for (int v = 0; v < 480; ++v)
      for (int u = 0; u < 640; ++u) {
        const double z = exact.depth.at<float>(v, u);
        const double expected = z < 0.45 || z > 5 ? 0 : z;
        worst = std::max(worst, std::abs(frame.depth.at<float>(v, u) - expected));
      }
    EXPECT_LT(worst, 0.0006) << "half a millimetre of rounding";
    EXPECT_LT((frame.robot_from_camera.matrix() - r.scene.robotFromCamera().matrix()).norm(), 1e-6);
  }
  // The robot had moved in between: the pictures are not all the same.
  EXPECT_GT(cv::norm(r.frames[0].depth, r.frames[2].depth, cv::NORM_INF), 0.1);
}

TEST(SimulateWiring, ThePictureShowsTheBlockWhereTheTruthHasItsBox) {
  const Recorded r;
  std::istringstream boxes(r.folder.read("boxes.jsonl"));
  for (const auto& frame : r.frames) {
    std::string line;
    ASSERT_TRUE(std::getline(boxes, line));
    const auto objects = nlohmann::json::parse(line)["objects"];
    const auto block = std::find_if(objects.begin(), objects.end(), [](const auto& o) { return o["kind"] == "block"; });
    ASSERT_NE(block, objects.end());
    const auto side = [&](std::size_t i) { return (*block)["bbox"][i].template get<int>(); };
    // A little inside the box's upper border, where the block is widest, and before the white wall.
    const int v = side(1) + (side(3) - side(1)) / 5;
    EXPECT_GT(frame.gray.at<uchar>(v, side(0) - 6), 110) << "white beside it";
    EXPECT_GT(frame.gray.at<uchar>(v, side(2) + 5), 110);
    int dark = 0;
    for (int u = side(0); u < side(2); ++u) dark += frame.gray.at<uchar>(v, u) < 80;
    EXPECT_GT(dark, 0.9 * (side(2) - side(0))) << "black inside";
  }
}

TEST(SimulateWiring, OdometryAndTruthFollowTheRobot) {
  const Recorded r;
  ASSERT_EQ(r.readings.size(), 11u);
  for (std::size_t i = 0; i < r.readings.size(); ++i) {
    const double t = r.readings[i].t - kFirstInstant;
    EXPECT_NEAR(t, 0.1 * static_cast<double>(i), 1e-6);
    const Pose2 truth = planarPart(r.scene.worldFromRobot(t));
    EXPECT_NEAR(r.readings[i].odom_from_robot.x, truth.x, 1e-6);
    EXPECT_NEAR(r.readings[i].odom_from_robot.yaw, truth.yaw, 1e-6);
  }
  EXPECT_GT(r.readings.back().odom_from_robot.x, 0.2);
  const auto poses = [&](const std::string& name, const auto& expected) {
    std::istringstream in(r.folder.read(name));
    int count = 0;
    for (std::string line; std::getline(in, line);) {
      if (line[0] == '#') continue;
      std::istringstream fields(line);
      double t = 0, x = 0, y = 0, z = 0;
      fields >> t >> x >> y >> z;
      EXPECT_LT((Eigen::Vector3d(x, y, z) - expected(t - kFirstInstant).translation()).norm(), 1e-5) << name;
      ++count;
    }
    return count;
  };
  EXPECT_EQ(poses("groundtruth.txt", [&](double t) { return r.scene.worldFromCamera(t); }), 3);
  EXPECT_EQ(poses("groundtruth_robot.txt", [&](double t) { return r.scene.worldFromRobot(t); }), 7);
}

TEST(SimulateWiring, ProgressAndDurationAreInSimulatedSeconds) {
  const test::TemporaryFolder folder;
  World world = exactWorld();
  world.camera.reset();
  std::vector<double> done;
  SimulateOptions options;
  options.progress = [&](double seconds, double all) {
    done.push_back(seconds);
    EXPECT_EQ(all, 1.0);
  };
  const auto result = simulate(world, folder.path(), options);
  ASSERT_EQ(done.size(), 15u);  // 11 readings and 4 scans
  EXPECT_TRUE(std::is_sorted(done.begin(), done.end()));
  EXPECT_NEAR(done.back(), 1.0, 1e-9);
  EXPECT_EQ(result.seconds, done.back());
  EXPECT_EQ(result.frames, 0);
  EXPECT_FALSE(result.interrupted);
}

}  // namespace
}  // namespace roomgraph
