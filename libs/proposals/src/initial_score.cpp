// SPDX-License-Identifier: BSD-3-Clause
// Part of roomgraph, object-level semantic SLAM.
#include "roomgraph/proposals/initial_score.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <opencv2/imgproc.hpp>

namespace roomgraph {
namespace {

constexpr double kFullArea = 0.08;  // of the image: boxes from here on have the full area part
constexpr int kEdgeSide = 120;      // px the box is reduced to before its edges are looked for

double edgePart(const Frame& frame, const Box2& box) {
  cv::Mat gray = frame.gray;
  const cv::Rect roi(cv::Point(static_cast<int>(box.u_min), static_cast<int>(box.v_min)),
                     cv::Point(static_cast<int>(box.u_max), static_cast<int>(box.v_max)));
  const cv::Mat& source = gray.empty() ? frame.color : gray;
  const cv::Rect inside = roi & cv::Rect(0, 0, source.cols, source.rows);
  if (source.empty() || inside.width < 8 || inside.height < 8) return 0;
  cv::Mat part = source(inside), edges;
  if (part.channels() == 3) cv::cvtColor(part, part, cv::COLOR_BGR2GRAY);
  const double scale = std::min(1.0, static_cast<double>(kEdgeSide) / std::max(inside.width, inside.height));
  if (scale < 1) cv::resize(part, part, cv::Size(), scale, scale, cv::INTER_AREA);
  cv::Canny(part, edges, 50, 120);
  std::vector<cv::Vec4i> segments;
  const int shortest = std::max(6, std::min(part.cols, part.rows) / 6);
  cv::HoughLinesP(edges, segments, 1, CV_PI / 90, shortest, shortest, 2);
  double length = 0;
  for (const auto& s : segments) length += std::hypot(s[2] - s[0], s[3] - s[1]);
  return std::min(1.0, length / (2.0 * (part.cols + part.rows)));
}

}  // namespace

std::string InitialScore::text() const {
  char buffer[96];
  std::snprintf(buffer, sizeof buffer, "area %.2f, edges %.2f, depth %.2f", area, edges, depth);
  return buffer;
}

InitialScore initialScore(const Frame& frame, const Detection& detection, double valid_depth_ratio) {
  InitialScore out;
  const Box2 box = clipped(detection.box, frame.camera.width, frame.camera.height);
  if (box.empty()) return out;
  out.area = std::min(1.0, std::sqrt(box.area() / (kFullArea * frame.camera.width * frame.camera.height)));
  out.edges = edgePart(frame, box);
  out.depth = std::clamp(valid_depth_ratio, 0.0, 1.0);
  out.value = 0.4 * out.area + 0.25 * out.edges + 0.35 * out.depth;
  return out;
}

}  // namespace roomgraph
