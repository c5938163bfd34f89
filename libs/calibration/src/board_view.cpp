// SPDX-License-Identifier: BSD-3-Clause
// Corners of a chessboard, its pose with covariance, and the depth that was measured on it.
#include "board_view.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <opencv2/calib3d.hpp>
#include <opencv2/core/eigen.hpp>
#include <opencv2/imgproc.hpp>
#include <vector>

namespace roomgraph {
namespace {

constexpr double kCorner_px = 0.2;      // nominal standard deviation of a corner
constexpr double kMostResidual_px = 1;  // root mean square
constexpr double kLeastDepths = 0.6;    // share of the pixels on the board
constexpr double kOffBoard_m = 0.15, kOffBoardShare = 0.1;  // depth that far from the board is of something else

// A board looks the same upside down: its rows are taken to run to the right, or down when they are upright.
void orient(std::vector<cv::Point2f>& corners, int columns) {
  const cv::Point2f along = corners[static_cast<std::size_t>(columns - 1)] - corners[0];
  const bool forward = std::abs(along.x) >= std::abs(along.y) ? along.x > 0 : along.y > 0;
  if (!forward) std::reverse(corners.begin(), corners.end());
}

std::vector<cv::Point2f> cornersIn(const cv::Mat& gray, const Board& board) {
  std::vector<cv::Point2f> corners;
  if (!cv::findChessboardCornersSB(gray, {board.columns, board.rows}, corners, cv::CALIB_CB_NORMALIZE_IMAGE)) return {};
  double nearest = 1e9;
  for (std::size_t i = 1; i < corners.size(); ++i) nearest = std::min(nearest, cv::norm(corners[i] - corners[i - 1]));
  const int half = std::clamp(static_cast<int>(nearest / 3), 2, 8);  // not as far as the next corners
  cv::cornerSubPix(gray, corners, {half, half}, {-1, -1}, {cv::TermCriteria::EPS + cv::TermCriteria::COUNT, 30, 0.01});
  orient(corners, board.columns);
  return corners;
}

// Of the inner corners, about their middle: x along the rows, y along the columns.
std::vector<cv::Point3f> pointsOf(const Board& board) {
  std::vector<cv::Point3f> out;
  for (int row = 0; row < board.rows; ++row)
    for (int column = 0; column < board.columns; ++column)
      out.emplace_back((column - 0.5 * (board.columns - 1)) * board.square_m,
                       (row - 0.5 * (board.rows - 1)) * board.square_m, 0);
  return out;
}

// Mean depth within the board's outer corners; nothing when too little of it was measured.
std::optional<DepthPatch> depthOn(const Frame& frame, const Board& board, const std::vector<cv::Point2f>& corners,
                                  const Pose3& camera_from_board) {
  if (!frame.hasDepth()) return std::nullopt;
  const auto columns = static_cast<std::size_t>(board.columns);
  const std::vector<cv::Point> outline{corners.front(), corners[columns - 1], corners.back(),
                                       corners[corners.size() - columns]};
  cv::Mat inside = cv::Mat::zeros(frame.depth.size(), CV_8U);
  cv::fillConvexPoly(inside, outline, 255);
  const Eigen::Vector3d normal = camera_from_board.linear().col(2);
  const double distance = normal.dot(camera_from_board.translation());
  DepthPatch out;
  double valid = 0, all = 0;
  for (int v = 0; v < inside.rows; ++v)
    for (int u = 0; u < inside.cols; ++u) {
      if (inside.at<uchar>(v, u) == 0) continue;
      ++all;
      const double z = frame.depth.at<float>(v, u);
      const Eigen::Vector3d ray = frame.camera.ray(u, v);
      const double expected = distance / normal.dot(ray);
      if (!(z > 0) || std::abs(z - expected) > kOffBoard_m + kOffBoardShare * expected) continue;
      out.point += z * ray;
      out.ray += ray;
      ++valid;
    }
  if (valid < kLeastDepths * all || valid == 0) return std::nullopt;
  out.point /= valid;
  out.ray /= valid;
  return out;
}

// Of the board's turn (rad) and of its middle (m), each per axis: from the derivatives of its corners' pixels.
void setSigmas(const cv::Mat& derivatives, BoardView& out) {
  Eigen::MatrixXd jacobian;
  cv::cv2eigen(derivatives.colRange(0, 6), jacobian);
  const Eigen::Matrix<double, 6, 6> information = jacobian.transpose() * jacobian / (kCorner_px * kCorner_px);
  const Eigen::Matrix<double, 6, 6> covariance = information.inverse();
  out.sigma_rad = std::sqrt(covariance.topLeftCorner<3, 3>().trace() / 3);
  out.sigma_m = std::sqrt(covariance.bottomRightCorner<3, 3>().trace() / 3);
}

}  // namespace

std::optional<BoardView> findBoard(const Frame& frame, const Board& board) {
  if (frame.gray.empty()) return std::nullopt;
  const auto corners = cornersIn(frame.gray, board);
  if (corners.empty()) return std::nullopt;
  const auto points = pointsOf(board);
  const cv::Matx33d camera(frame.camera.fx, 0, frame.camera.cx, 0, frame.camera.fy, frame.camera.cy, 0, 0, 1);
  cv::Vec3d turn, place;
  if (!cv::solvePnP(points, corners, camera, cv::noArray(), turn, place)) return std::nullopt;
  std::vector<cv::Point2f> projected;
  cv::Mat derivatives;
  cv::projectPoints(points, turn, place, camera, cv::noArray(), projected, derivatives);
  if (cv::norm(projected, corners, cv::NORM_L2) > kMostResidual_px * std::sqrt(static_cast<double>(corners.size())))
    return std::nullopt;
  BoardView out;
  out.t = frame.t;
  cv::Matx33d rotation;
  cv::Rodrigues(turn, rotation);
  Eigen::Matrix3d linear;
  cv::cv2eigen(rotation, linear);
  out.camera_from_board.linear() = linear;
  out.camera_from_board.translation() = Eigen::Vector3d(place[0], place[1], place[2]);
  setSigmas(derivatives, out);
  out.depth = depthOn(frame, board, corners, out.camera_from_board);
  return out;
}

}  // namespace roomgraph
