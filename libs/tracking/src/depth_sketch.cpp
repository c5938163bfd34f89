// SPDX-License-Identifier: BSD-3-Clause
// Reduction of a depth image, and surfaces of one view in the free space of another.
#include "depth_sketch.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "dense_image.h"

namespace roomgraph::tracking {
namespace {

constexpr int kWidth = 80;
constexpr float kFarthest_m = 5;
constexpr int kStride = 2;
constexpr int kLeastShared = 125;
constexpr double kTolerance_m = 0.06, kTolerancePerM = 0.04;

struct Votes {
  int agree = 0, contradict = 0;
};

// Depths about a pixel; nothing where any is unknown.
struct DepthRange {
  double nearest, farthest;
};

std::optional<DepthRange> depthsAbout(const DepthSketch& sketch, int u, int v) {
  int nearest = std::numeric_limits<std::uint16_t>::max(), farthest = 0;
  for (int y = v - 1; y <= v + 1; ++y)
    for (int x = u - 1; x <= u + 1; ++x) {
      const int z = sketch.depth_mm.at<std::uint16_t>(y, x);
      if (z == 0) return std::nullopt;
      nearest = std::min(nearest, z);
      farthest = std::max(farthest, z);
    }
  return DepthRange{1e-3 * nearest, 1e-3 * farthest};
}

// What `seen` shows and `through` should see, too: either there, or nearer than the surface that `through`
// sees.
void compare(const DepthSketch& through, const DepthSketch& seen, const Pose3& through_from_seen,
             Votes& votes) {
  for (int v = 0; v < seen.depth_mm.rows; v += kStride)
    for (int u = 0; u < seen.depth_mm.cols; u += kStride) {
      const int z = seen.depth_mm.at<std::uint16_t>(v, u);
      if (z == 0) continue;
      const Eigen::Vector3d point = through_from_seen * seen.camera.backProject(u, v, 1e-3 * z);
      if (point.z() <= 0) continue;
      const Eigen::Vector2d pixel = through.camera.project(point);
      const int x = static_cast<int>(std::lround(pixel.x())), y = static_cast<int>(std::lround(pixel.y()));
      if (x < 1 || y < 1 || x + 1 >= through.depth_mm.cols || y + 1 >= through.depth_mm.rows) continue;
      const auto there = depthsAbout(through, x, y);
      if (!there) continue;
      const double tolerance = kTolerance_m + kTolerancePerM * point.z();
      if (point.z() < there->nearest - tolerance)
        ++votes.contradict;
      else if (point.z() < there->farthest + tolerance)
        ++votes.agree;
    }
}

}  // namespace

DepthSketch sketchDepth(const Frame& frame, const std::vector<Box2>& excluded) {
  DepthSketch out{frame.camera.scaled(static_cast<double>(kWidth) / frame.camera.width), {}};
  coarseDepth(frame, excluded, out.camera, kFarthest_m).convertTo(out.depth_mm, CV_16U, 1000);
  return out;
}

double agreement(const std::vector<PlacedSketch>& a, const std::vector<PlacedSketch>& b,
                 const Pose3& a_from_b) {
  double least = 1;
  for (const PlacedSketch& one : a)
    for (const PlacedSketch& other : b) {
      const Pose3 between = one.place_from_camera.inverse() * a_from_b * other.place_from_camera;
      Votes votes;
      compare(*one.sketch, *other.sketch, between, votes);
      compare(*other.sketch, *one.sketch, between.inverse(), votes);
      const int both = votes.agree + votes.contradict;
      if (both >= kLeastShared) least = std::min(least, static_cast<double>(votes.agree) / both);
    }
  return least;
}

}  // namespace roomgraph::tracking
