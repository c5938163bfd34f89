// SPDX-License-Identifier: BSD-3-Clause
// FeatureOdometry on a recorded hand-held sequence against its ground truth.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <filesystem>
#include <fstream>
#include <map>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <sstream>

#include "data_folder.h"
#include "feature_odometry.h"

namespace roomgraph {
namespace {

namespace fs = std::filesystem;

fs::path sequence() {
  return test::dataFolder() / "rgbd/7scenes_redkitchen_10hz";
}

/// True camera positions by time, rounded to ms.
std::map<long, Eigen::Vector3d> truePositions() {
  std::map<long, Eigen::Vector3d> out;
  std::ifstream in(sequence() / "groundtruth.txt");
  for (std::string line; std::getline(in, line);) {
    std::istringstream fields(line);
    double t = 0;
    Eigen::Vector3d p;
    if (line[0] != '#' && fields >> t >> p.x() >> p.y() >> p.z()) out[std::lround(1000 * t)] = p;
  }
  return out;
}

Frame load(const std::string& association) {
  std::istringstream fields(association);
  Frame frame;
  double depth_t = 0;
  std::string color, depth;
  fields >> frame.t >> color >> depth_t >> depth;
  frame.color = cv::imread(sequence() / color);
  cv::cvtColor(frame.color, frame.gray, cv::COLOR_BGR2GRAY);
  cv::imread(sequence() / depth, cv::IMREAD_UNCHANGED).convertTo(frame.depth, CV_32F, 0.001);
  frame.camera = {640, 480, 525, 525, 320, 240, {}};
  return frame;
}

TEST(RealSequence, FollowsAHandheldKinect) {
  if (!fs::exists(sequence() / "associations.txt")) GTEST_SKIP() << "missing: " << sequence();
  FeatureOdometry odometry;
  std::ifstream associations(sequence() / "associations.txt");
  std::string line;
  for (int i = 0; i < 80 && std::getline(associations, line); ++i) {
    const auto result = odometry.track(load(line), {});
    EXPECT_TRUE(result.tracked) << i << ": " << result.reason;
  }
  const auto truth = truePositions();
  const auto trajectory = odometry.trajectory();
  ASSERT_EQ(trajectory.size(), 80u);
  Eigen::Matrix3Xd estimated(3, 80), actual(3, 80);
  for (int i = 0; i < 80; ++i) {
    const auto& stamped = trajectory.poses()[static_cast<std::size_t>(i)];
    estimated.col(i) = stamped.pose.translation();
    actual.col(i) = truth.at(std::lround(1000 * stamped.t));
  }
  const Eigen::Isometry3d align(Eigen::umeyama(estimated, actual, false));
  const double rmse = std::sqrt(((align * estimated) - actual).colwise().squaredNorm().mean());
  EXPECT_LT(rmse, 0.06);
}

}  // namespace
}  // namespace roomgraph
