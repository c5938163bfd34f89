// SPDX-License-Identifier: BSD-3-Clause
// Floor patches and upright cells of depth images of a known room.
#include "depth_view.h"

#include <gmock/gmock.h>

#include <random>

#include "roomgraph/geometry/degree.h"

namespace roomgraph::test {
namespace {

// A wall 3 m ahead of the robot and a box of 0.5 m before it, on the floor, as a camera on the robot sees
// them.
class DepthViewTest : public ::testing::Test {
 protected:
  static constexpr double kWall_m = 3, kBox_m = 2, kBoxHeight_m = 0.5;

  Frame frameOf(double sigma_per_m2 = 0) {
    Frame frame;
    frame.t = 7;
    frame.camera = {320, 240, 262, 262, 159.5, 119.5, {}};
    frame.robot_from_camera = poseFromYpr(0.1, 0, 0.8, 3 * kDegree, 14 * kDegree, -1 * kDegree);
    frame.robot_from_camera.linear() *= bodyFromOptical();
    frame.depth = cv::Mat::zeros(240, 320, CV_32F);
    std::mt19937 random(4);
    std::normal_distribution<double> deviate;
    for (int v = 0; v < 240; ++v)
      for (int u = 0; u < 320; ++u) {
        const double z = depthOf(frame, frame.camera.ray(u, v));
        frame.depth.at<float>(v, u) = static_cast<float>(z + sigma_per_m2 * z * z * deviate(random));
      }
    return frame;
  }
  static double depthOf(const Frame& frame, const Eigen::Vector3d& ray) {
    const Eigen::Vector3d from = frame.robot_from_camera.translation(),
                          d = frame.robot_from_camera.linear() * ray;
    double z = (kWall_m - from.x()) / d.x();
    if (d.z() < 0) z = std::min(z, -from.z() / d.z());
    const double to_box = (kBox_m - from.x()) / d.x();
    const Eigen::Vector3d on_box = from + to_box * d;
    return on_box.z() > 0 && on_box.z() < kBoxHeight_m && std::abs(on_box.y()) < 0.4 ? std::min(z, to_box)
                                                                                     : z;
  }
};

TEST_F(DepthViewTest, FloorPatchesLieOnTheFloor) {
  const Frame frame = frameOf();
  const DepthView view = makeDepthView(frame, groundInCamera(frame.robot_from_camera), std::nullopt);
  EXPECT_EQ(view.t, 7);
  EXPECT_GE(view.floor.size(), 3u);
  EXPECT_TRUE(view.upright.empty()) << "nothing to compare them with";
  double nearest = 99, farthest = 0;
  for (const DepthPatch& patch : view.floor) {
    EXPECT_NEAR((frame.robot_from_camera * patch.point).z(), 0, 2e-3);
    nearest = std::min(nearest, patch.point.z());
    farthest = std::max(farthest, patch.point.z());
  }
  EXPECT_GT(farthest - nearest, 0.5) << "near and far floor are apart";
}

// A plane that is seen with wrong depth scale and bias is made right by correcting the means alone.
TEST_F(DepthViewTest, MeansTakeTheCorrectionOfTheirPixels) {
  Frame frame = frameOf();
  constexpr double kScale = 1.03, kBias = -0.04;
  const Plane floor = groundInCamera(frame.robot_from_camera);
  const DepthView truth = makeDepthView(frame, floor, std::nullopt);
  frame.depth = (frame.depth - kBias) / kScale;
  // The floor as this image shows it is no exact plane; near enough for the search.
  Plane seen = floor;
  seen.offset = floor.offset * 0.99;
  const DepthView view = makeDepthView(frame, seen, std::nullopt);
  ASSERT_FALSE(view.floor.empty());
  for (const DepthPatch& patch : view.floor)
    EXPECT_NEAR((frame.robot_from_camera * (kScale * patch.point + kBias * patch.ray)).z(), 0, 2e-3);
}

TEST_F(DepthViewTest, FeetOfWallsAndFurnitureAreNoFloor) {
  const Frame frame = frameOf(0.001);
  const DepthView view = makeDepthView(frame, groundInCamera(frame.robot_from_camera), std::nullopt);
  ASSERT_FALSE(view.floor.empty());
  for (const DepthPatch& patch : view.floor)
    EXPECT_NEAR((frame.robot_from_camera * patch.point).z(), 0, 4e-3);
}

TEST_F(DepthViewTest, UprightCellsAreThoseAtTheHeightOfTheLidar) {
  const Frame frame = frameOf(0.0005);
  const DepthView view = makeDepthView(frame, std::nullopt, HeightBand{0.1, 0.7});
  EXPECT_TRUE(view.floor.empty());
  int on_box = 0, on_wall = 0;
  for (const DepthCell& cell : view.upright) {
    const Eigen::Vector3d at = frame.robot_from_camera * cell.patch.point;
    const Eigen::Vector3d normal = frame.robot_from_camera.linear() * cell.normal;
    EXPECT_GT(at.z(), 0.1);
    EXPECT_LT(at.z(), 0.7);
    EXPECT_GT(std::abs(normal.x()), 0.8) << "box and wall face the robot";
    EXPECT_LT(normal.x(), 0) << "towards the camera";
    const bool is_box = std::abs(at.x() - kBox_m) < 0.05;
    (is_box ? on_box : on_wall)++;
    EXPECT_NEAR(at.x(), is_box ? kBox_m : kWall_m, 0.05);
  }
  EXPECT_GT(on_box, 50);
  EXPECT_GT(on_wall, 50);
}

TEST_F(DepthViewTest, HolesGiveNothing) {
  Frame frame = frameOf();
  frame.depth = 0;
  const DepthView view = makeDepthView(frame, groundInCamera(frame.robot_from_camera), HeightBand{0, 1});
  EXPECT_TRUE(view.floor.empty());
  EXPECT_TRUE(view.upright.empty());
  EXPECT_FALSE(medianDepth(frame));
}

TEST_F(DepthViewTest, MedianDepthIsThatOfThePixels) {
  const Frame frame = frameOf();
  std::vector<float> all(frame.depth.begin<float>(), frame.depth.end<float>());
  std::nth_element(all.begin(), all.begin() + static_cast<long>(all.size() / 2), all.end());
  EXPECT_NEAR(medianDepth(frame).value_or(0), all[all.size() / 2], 0.1);
}

}  // namespace
}  // namespace roomgraph::test
