// SPDX-License-Identifier: BSD-3-Clause
// Edge detection on the reduced box, and segments supported by the depth mask.
#include "find_edges.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace roomgraph {
namespace {

constexpr int kSide = 140;  // px; a longer side of the box is reduced to it
// Rim around the box, whose sides are edges of the object: px, and a share of the box's size.
constexpr double kBoxRim = 3, kRimShare = 0.03;
constexpr double kLeastBox_px = 8;                     // of both sides; smaller boxes show no lines
constexpr double kCannyLow = 50, kCannyHigh = 120;     // gradient thresholds of the 8-bit image
constexpr double kHoughAngle_rad = CV_PI / 90;         // resolution
constexpr int kLeastSegment_px = 6, kSegmentPart = 6;  // least length; also this part of the box's shorter side
constexpr int kLargestGap_px = 2;                      // within a segment
// A segment is supported by depth points this near, px: a constant, and the spacing of samples spread over the box.
constexpr double kReach_px = 4, kReachSpacings = 2, kSamplesPerBox = 1000;

cv::Mat grayPart(const Frame& frame, const cv::Rect& roi) {
  const cv::Mat& source = frame.gray.empty() ? frame.color : frame.gray;
  cv::Mat part = source(roi);
  if (part.channels() == 3) cv::cvtColor(part, part, cv::COLOR_BGR2GRAY);
  return part;
}

double lengthOf(const Segment2& s) {
  return (s.b - s.a).norm();
}

void findSegments(const cv::Mat& edges, BoxEdges& out) {
  std::vector<cv::Vec4i> lines;
  const int shortest = std::max(kLeastSegment_px, std::min(edges.cols, edges.rows) / kSegmentPart);
  cv::HoughLinesP(edges, lines, 1, kHoughAngle_rad, shortest, shortest, kLargestGap_px);
  for (const auto& l : lines)
    out.segments.push_back({out.origin + Eigen::Vector2d(l[0] + 0.5, l[1] + 0.5) / out.scale,
                            out.origin + Eigen::Vector2d(l[2] + 0.5, l[3] + 0.5) / out.scale});
  std::stable_sort(out.segments.begin(), out.segments.end(),
                   [](const Segment2& a, const Segment2& b) { return lengthOf(a) > lengthOf(b); });
}

}  // namespace

double BoxEdges::distanceAt(const Eigen::Vector2d& pixel) const {
  const Eigen::Vector2d p = (pixel - origin) * scale;
  const int x = std::clamp(static_cast<int>(std::clamp(p.x(), -1e6, 1e6)), 0, distance.cols - 1);
  const int y = std::clamp(static_cast<int>(std::clamp(p.y(), -1e6, 1e6)), 0, distance.rows - 1);
  const double beyond = (p - Eigen::Vector2d(x + 0.5, y + 0.5)).cwiseAbs().maxCoeff();
  return (distance.at<float>(y, x) + (beyond > 1 ? beyond : 0)) / scale;
}

void addDistances(BoxEdges& edges) {
  if (edges.pixels.empty() || !edges.distance.empty()) return;
  cv::Mat inverse;
  cv::bitwise_not(edges.pixels, inverse);
  cv::distanceTransform(inverse, edges.distance, cv::DIST_L2, 3);
}

double totalLength(const std::vector<Segment2>& segments) {
  double sum = 0;
  for (const Segment2& s : segments) sum += lengthOf(s);
  return sum;
}

BoxEdges findEdges(const Frame& frame, const Box2& box) {
  BoxEdges out;
  const cv::Mat& source = frame.gray.empty() ? frame.color : frame.gray;
  const double du = kBoxRim + kRimShare * box.width(), dv = kBoxRim + kRimShare * box.height();
  const Box2 rimmed =
      clipped({box.u_min - du, box.v_min - dv, box.u_max + du, box.v_max + dv}, source.cols, source.rows);
  if (source.empty() || std::min({box.width(), box.height(), rimmed.width(), rimmed.height()}) < kLeastBox_px)
    return out;
  const cv::Rect roi(cv::Point(static_cast<int>(rimmed.u_min), static_cast<int>(rimmed.v_min)),
                     cv::Point(static_cast<int>(rimmed.u_max), static_cast<int>(rimmed.v_max)));
  cv::Mat part = grayPart(frame, roi);
  out.scale = std::min(1.0, static_cast<double>(kSide) / std::max(roi.width, roi.height));
  out.origin = {roi.x, roi.y};
  if (out.scale < 1) cv::resize(part, part, cv::Size(), out.scale, out.scale, cv::INTER_AREA);
  cv::Canny(part, out.pixels, kCannyLow, kCannyHigh);
  findSegments(out.pixels, out);
  return out;
}

std::vector<Segment2> supportedSegments(const std::vector<Segment2>& segments, const DepthMask& mask,
                                        const Box2& box) {
  if (mask.points.empty()) return segments;
  const double reach = kReach_px + kReachSpacings * std::sqrt(box.area() / kSamplesPerBox);
  std::vector<Segment2> out;
  for (const Segment2& s : segments) {
    const Eigen::Vector2d middle = (s.a + s.b) / 2;
    const bool near = std::any_of(mask.points.begin(), mask.points.end(), [&](const MaskPoint& p) {
      return std::abs(p.u - middle.x()) < reach && std::abs(p.v - middle.y()) < reach;
    });
    if (near) out.push_back(s);
  }
  return out;
}

}  // namespace roomgraph
