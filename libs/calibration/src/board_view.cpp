// SPDX-License-Identifier: BSD-3-Clause
// Corners of a chessboard, its pose with covariance, and the depth that was measured on it.
#include "board_view.h"

#include <Eigen/Cholesky>
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

double brightnessBetween(const cv::Mat& gray, const cv::Point2f& a, const cv::Point2f& b) {
  const cv::Point2f middle = (a + b) / 2;
  return gray.at<uchar>(std::clamp(cvRound(middle.y), 0, gray.rows - 1), std::clamp(cvRound(middle.x), 0, gray.cols - 1));
}

// The first square is dark. A board with an odd number of corners along one edge and an even one along the other has a light
// one at its other end; one that looks the same upside down is taken to have rows that run to the right, or down when they are
// upright.
void orient(std::vector<cv::Point2f>& corners, const Board& board, const cv::Mat& gray) {
  const auto columns = static_cast<std::size_t>(board.columns);
  const cv::Point2f along = corners[columns - 1] - corners[0];
  bool forward = std::abs(along.x) >= std::abs(along.y) ? along.x > 0 : along.y > 0;
  if ((board.columns + board.rows) % 2 == 1)
    forward = brightnessBetween(gray, corners[0], corners[columns + 1]) <
              brightnessBetween(gray, corners[corners.size() - 1], corners[corners.size() - columns - 2]);
  if (!forward) std::reverse(corners.begin(), corners.end());
}

std::vector<cv::Point2f> cornersIn(const cv::Mat& gray, const Board& board) {
  std::vector<cv::Point2f> corners;
  if (!cv::findChessboardCornersSB(gray, {board.columns, board.rows}, corners, cv::CALIB_CB_NORMALIZE_IMAGE)) return {};
  double nearest = 1e9;
  const auto columns = static_cast<std::size_t>(board.columns);
  for (std::size_t i = 1; i < corners.size(); ++i) nearest = std::min(nearest, cv::norm(corners[i] - corners[i - 1]));
  for (std::size_t i = columns; i < corners.size(); ++i)
    nearest = std::min(nearest, cv::norm(corners[i] - corners[i - columns]));
  const int half = std::clamp(static_cast<int>(nearest / 3), 2, 8);  // not as far as the next corners
  cv::cornerSubPix(gray, corners, {half, half}, {-1, -1}, {cv::TermCriteria::EPS + cv::TermCriteria::COUNT, 30, 0.01});
  orient(corners, board, gray);
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

// From the derivatives of the corners' pixels by a small turn in the board's frame and by the place of its middle.
void setCovariances(const std::vector<cv::Point3f>& points, const PinholeCamera& camera, BoardView& out) {
  Eigen::Matrix<double, 6, 6> information = Eigen::Matrix<double, 6, 6>::Zero();
  for (const cv::Point3f& corner : points) {
    const Eigen::Vector3d on_board(corner.x, corner.y, corner.z), p = out.camera_from_board * on_board;
    Eigen::Matrix<double, 3, 6> moved;
    for (int k = 0; k < 3; ++k)
      moved.col(k) = out.camera_from_board.linear() * Eigen::Vector3d::Unit(k).cross(on_board);
    moved.rightCols<3>().setIdentity();
    Eigen::Matrix<double, 2, 3> pixel;
    pixel << camera.fx / p.z(), 0, -camera.fx * p.x() / (p.z() * p.z()),  //
        0, camera.fy / p.z(), -camera.fy * p.y() / (p.z() * p.z());
    const Eigen::Matrix<double, 2, 6> derivatives = pixel * moved / kCorner_px;
    information += derivatives.transpose() * derivatives;
  }
  const Eigen::Matrix<double, 6, 6> covariance = information.ldlt().solve(Eigen::Matrix<double, 6, 6>::Identity());
  out.turn_covariance = covariance.topLeftCorner<3, 3>();
  out.place_covariance = covariance.bottomRightCorner<3, 3>();
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
  cv::projectPoints(points, turn, place, camera, cv::noArray(), projected);
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
  setCovariances(points, frame.camera, out);
  out.depth = depthOn(frame, board, corners, out.camera_from_board);
  return out;
}

}  // namespace roomgraph
