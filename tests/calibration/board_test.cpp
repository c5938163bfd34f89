// SPDX-License-Identifier: BSD-3-Clause
// Chessboards in pictures painted from known places.
#include <gmock/gmock.h>

#include <opencv2/imgproc.hpp>

#include "board_view.h"
#include "roomgraph/core/errors.h"
#include "roomgraph/geometry/degree.h"

namespace roomgraph::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

const Board kBoard{9, 6, 0.04};

struct Seen {
  Pose3 camera_from_board = Pose3::Identity();
  double depth_scale = 1, depth_bias_m = 0;
};

// A square of the board, or its white edge as wide as one; nothing beyond that.
std::optional<double> brightnessAt(const Board& board, double x, double y) {
  const double column = x / board.square_m + 0.5 * (board.columns + 1), row = y / board.square_m + 0.5 * (board.rows + 1);
  if (column < -1 || row < -1 || column > board.columns + 2 || row > board.rows + 2) return std::nullopt;
  if (column < 0 || row < 0 || column > board.columns + 1 || row > board.rows + 1) return 230;
  return (static_cast<int>(column) + static_cast<int>(row)) % 2 == 0 ? 25 : 230;
}

// Every pixel is the mean of 5 by 5 rays; its depth is that of its middle.
Frame picture(const Seen& seen, const Board& board = kBoard) {
  constexpr int kRays = 5;
  Frame out;
  out.t = 12.5;
  out.camera = {640, 480, 525, 530, 318, 242, {}};
  out.gray = cv::Mat(480, 640, CV_8U, cv::Scalar(120));
  out.depth = cv::Mat::zeros(480, 640, CV_32F);
  const Eigen::Vector3d normal = seen.camera_from_board.linear().col(2);
  const double distance = normal.dot(seen.camera_from_board.translation());
  const Pose3 board_from_camera = seen.camera_from_board.inverse();
  for (int v = 0; v < 480; ++v)
    for (int u = 0; u < 640; ++u) {
      double sum = 0;
      for (int i = 0; i < kRays * kRays; ++i) {
        const Eigen::Vector3d ray = out.camera.ray(u + (i % kRays - 2) / 5.0, v + (i / kRays - 2) / 5.0);
        const Eigen::Vector3d on_board = board_from_camera * (distance / normal.dot(ray) * ray);
        sum += brightnessAt(board, on_board.x(), on_board.y()).value_or(120) / (kRays * kRays);
      }
      out.gray.at<uchar>(v, u) = cv::saturate_cast<uchar>(sum);
      const double z = distance / normal.dot(out.camera.ray(u, v));
      out.depth.at<float>(v, u) = static_cast<float>((z - seen.depth_bias_m) / seen.depth_scale);
    }
  return out;
}

// As a camera ahead of an upright board sees it, then turned.
Seen turned(double yaw_deg, double pitch_deg, double roll_deg, const Eigen::Vector3d& at) {
  Seen out;
  const Eigen::AngleAxisd yaw(yaw_deg * kDegree, Eigen::Vector3d::UnitY()), pitch(pitch_deg * kDegree, Eigen::Vector3d::UnitX()),
      roll(roll_deg * kDegree, Eigen::Vector3d::UnitZ());
  out.camera_from_board.linear() = (roll * yaw * pitch).toRotationMatrix();
  out.camera_from_board.translation() = at;
  return out;
}

TEST(FindBoard, IsWhereItWasPainted) {
  for (const Seen& seen : {turned(0, 0, 0, {0, 0, 1}), turned(25, 5, 0, {0.1, -0.1, 1.2}), turned(-35, -10, 8, {-0.2, 0.1, 1.6}),
                           turned(10, 20, -30, {0.3, 0.2, 1.4})}) {
    const auto view = findBoard(picture(seen), kBoard);
    ASSERT_TRUE(view);
    EXPECT_EQ(view->t, 12.5);
    const Pose3 off = view->camera_from_board.inverse() * seen.camera_from_board;
    const double place = std::sqrt(view->place_covariance.trace()), turn = std::sqrt(view->turn_covariance.trace());
    EXPECT_LT(off.translation().norm(), std::max(0.0005, 2 * place));
    EXPECT_LT(rotationAngle(off), std::max(0.001, 2 * turn));
    EXPECT_LT(place, 0.004);
    EXPECT_LT(turn, 0.03);
  }
}

TEST(FindBoard, KnowsWhichWayIsUpByTheColourOfItsFirstSquare) {
  for (const double roll : {0.0, 50.0, 90.0, 135.0, 180.0, 230.0, 300.0}) {
    const Seen seen = turned(10, 5, roll, {0, 0, 1});
    const auto view = findBoard(picture(seen), kBoard);
    ASSERT_TRUE(view) << roll;
    EXPECT_LT(rotationAngle(view->camera_from_board.inverse() * seen.camera_from_board), 0.02) << roll;
  }
}

// One with even numbers along both edges has two right ways up.
TEST(FindBoard, RowsRunToTheRightWhereBothWaysAreTheSame) {
  const Board even{8, 6, 0.04};
  for (const double roll : {10.0, 190.0}) {
    const auto view = findBoard(picture(turned(0, 5, roll, {0, 0, 1}), even), even);
    ASSERT_TRUE(view) << roll;
    EXPECT_GT(view->camera_from_board.linear()(0, 0), 0.9) << roll;
  }
}

// Errors of many pictures with noise against the covariance that each states, axis by axis.
TEST(FindBoard, CovariancesAreThoseOfNoise) {
  const Seen seen = turned(20, 10, 5, {0.1, 0, 1.5});
  const Frame clean = picture(seen);
  Eigen::Vector3d turns = Eigen::Vector3d::Zero(), places = Eigen::Vector3d::Zero();
  constexpr int kPictures = 30;
  std::optional<BoardView> view;
  for (int i = 0; i < kPictures; ++i) {
    Frame noisy = clean;
    cv::Mat noise(clean.gray.size(), CV_16S), sum;
    cv::RNG(static_cast<std::uint64_t>(i + 1)).fill(noise, cv::RNG::NORMAL, 0, 4);
    clean.gray.convertTo(sum, CV_16S);
    sum += noise;
    sum.convertTo(noisy.gray, CV_8U);
    view = findBoard(noisy, kBoard);
    ASSERT_TRUE(view);
    const Pose3 off = view->camera_from_board.inverse() * seen.camera_from_board;
    turns += logSO3(off.linear()).cwiseAbs2() / kPictures;
    places += (view->camera_from_board.translation() - seen.camera_from_board.translation()).cwiseAbs2() / kPictures;
  }
  // Noise is not that of a corner by .2 px; its shares on the axes are what is compared, and that it is no larger.
  const Eigen::Vector3d turn = turns.cwiseQuotient(view->turn_covariance.diagonal()),
                        place = places.cwiseQuotient(view->place_covariance.diagonal());
  EXPECT_LT(turn.maxCoeff() / turn.minCoeff(), 6) << turn.transpose();
  EXPECT_LT(place.maxCoeff() / place.minCoeff(), 6) << place.transpose();
  EXPECT_GT(view->turn_covariance(0, 0) / view->turn_covariance(2, 2), 20) << "tilt is known least";
  EXPECT_LT(turn.maxCoeff(), 1.5);
  EXPECT_LT(place.maxCoeff(), 1.5);
}

// Of depths scale z + bias = true, the patch lies on the board once it is corrected.
TEST(FindBoard, HasTheDepthMeasuredOnIt) {
  Seen seen = turned(20, -10, 0, {0.1, 0, 1.3});
  seen.depth_scale = 1.03;
  seen.depth_bias_m = -0.02;
  Frame frame = picture(seen);
  frame.depth(cv::Rect(300, 220, 20, 20)) = 0;                // a hole
  frame.depth(cv::Rect(340, 250, 15, 15)) = cv::Scalar(0.6);  // something before it
  const auto view = findBoard(frame, kBoard);
  ASSERT_TRUE(view && view->depth);
  const Eigen::Vector3d corrected = seen.depth_scale * view->depth->point + seen.depth_bias_m * view->depth->ray;
  const Eigen::Vector3d normal = seen.camera_from_board.linear().col(2);
  EXPECT_NEAR(normal.dot(corrected - seen.camera_from_board.translation()), 0, 1e-4);
  EXPECT_NEAR(view->depth->ray.z(), 1, 1e-9);

  frame.depth(cv::Rect(0, 0, 640, 240)) = 0;
  EXPECT_FALSE(findBoard(frame, kBoard)->depth) << "half of it is missing";
  frame.depth = cv::Mat();
  EXPECT_FALSE(findBoard(frame, kBoard)->depth);
}

TEST(FindBoard, IsNotFoundWhereNoneIs) {
  const Frame frame = picture(turned(0, 0, 0, {0, 0, 1}));
  EXPECT_FALSE(findBoard(frame, {8, 5, 0.04})) << "another board";
  EXPECT_FALSE(findBoard(picture(turned(0, 0, 0, {0.6, 0, 1})), kBoard)) << "part of it is out of the picture";
  Frame blank = frame;
  blank.gray = cv::Mat(480, 640, CV_8U, cv::Scalar(120));
  EXPECT_FALSE(findBoard(blank, kBoard));
  blank.gray = cv::Mat();
  EXPECT_FALSE(findBoard(blank, kBoard));
}

TEST(ParseBoard, TakesColumnsRowsAndTheEdgeOfASquare) {
  EXPECT_EQ(parseBoard("9x6x0.04", "--board"), (Board{9, 6, 0.04}));
  for (const char* text : {"", "9x6", "9x6x", "9x6x0.04m", "9,6,0.04", "x6x0.04", "9x6x0.04x1", "-9x6x0.04", "9x6xnan"})
    try {
      parseBoard(text, "--board");
      ADD_FAILURE() << text;
    } catch (const ConfigError& error) {
      EXPECT_THAT(error.what(), AllOf(HasSubstr("--board"), HasSubstr("9x6x0.04")));
    }
  EXPECT_THROW(parseBoard("2x6x0.04", ""), ConfigError);
  EXPECT_THROW(parseBoard("9x600x0.04", ""), ConfigError);
  EXPECT_THROW(parseBoard("9x6x40", ""), ConfigError) << "millimetres";
}

}  // namespace
}  // namespace roomgraph::test
