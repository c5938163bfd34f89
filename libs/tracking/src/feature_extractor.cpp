// SPDX-License-Identifier: BSD-3-Clause
// FAST corners spread over pyramid levels, intensity-centroid orientation, depth on smooth surfaces.
#include "feature_extractor.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <iterator>
#include <opencv2/features2d.hpp>
#include <opencv2/imgproc.hpp>

namespace roomgraph::tracking {
namespace {

constexpr int kBorderPx = 19;  // of each level: the rotated 31 px descriptor patch must fit
constexpr int kHalfPatchPx = 15;

/// Half widths of the rows of a disc of radius kHalfPatchPx.
std::array<int, kHalfPatchPx + 1> discRows() {
  std::array<int, kHalfPatchPx + 1> half{};
  for (int v = 0; v <= kHalfPatchPx; ++v)
    half[static_cast<std::size_t>(v)] =
        static_cast<int>(std::floor(std::sqrt(kHalfPatchPx * kHalfPatchPx - v * v + 0.5)));
  return half;
}

/// Direction from the patch centre to its intensity centroid, degrees (Rublee et al., Eq. 1-3).
float patchAngle(const cv::Mat& image, const cv::Point& center) {
  static const auto kRows = discRows();
  int m01 = 0, m10 = 0;
  for (int v = -kHalfPatchPx; v <= kHalfPatchPx; ++v) {
    const auto* row = image.ptr<std::uint8_t>(center.y + v) + center.x;
    const int half = kRows[static_cast<std::size_t>(std::abs(v))];
    int sum = 0;
    for (int u = -half; u <= half; ++u) {
      sum += row[u];
      m10 += u * row[u];
    }
    m01 += v * sum;
  }
  return cv::fastAtan2(static_cast<float>(m01), static_cast<float>(m10));
}

bool stronger(const cv::KeyPoint& a, const cv::KeyPoint& b) {
  if (a.response != b.response) return a.response > b.response;
  return a.pt.y != b.pt.y ? a.pt.y < b.pt.y : a.pt.x < b.pt.x;
}

/// Takes the strongest corner of each cell, then the second of each, … until there are `wanted`.
std::vector<cv::KeyPoint> spread(const std::vector<cv::KeyPoint>& corners, cv::Size size, int cell_px,
                                 std::size_t wanted) {
  const int columns = (size.width + cell_px - 1) / cell_px, rows = (size.height + cell_px - 1) / cell_px;
  std::vector<std::vector<cv::KeyPoint>> cells(static_cast<std::size_t>(columns * rows));
  for (const auto& corner : corners)
    cells[static_cast<std::size_t>(static_cast<int>(corner.pt.y) / cell_px * columns +
                                   static_cast<int>(corner.pt.x) / cell_px)]
        .push_back(corner);
  for (auto& cell : cells) std::sort(cell.begin(), cell.end(), stronger);
  std::vector<cv::KeyPoint> chosen;
  for (std::size_t rank = 0; chosen.size() < wanted; ++rank) {
    std::vector<cv::KeyPoint> round;
    for (const auto& cell : cells)
      if (rank < cell.size()) round.push_back(cell[rank]);
    if (round.empty()) break;
    std::sort(round.begin(), round.end(), stronger);
    round.resize(std::min(round.size(), wanted - chosen.size()));
    chosen.insert(chosen.end(), round.begin(), round.end());
  }
  return chosen;
}

/// Share of the features that each level gets: levels hold them in proportion to their edge length.
std::vector<std::size_t> quotas(const TrackingParameters& parameters) {
  const double ratio = 1 / parameters.scale_factor;
  double sum = 0;
  for (int level = 0; level < parameters.pyramid_levels; ++level) sum += std::pow(ratio, level);
  std::vector<std::size_t> out;
  for (int level = 0; level < parameters.pyramid_levels; ++level)
    out.push_back(
        static_cast<std::size_t>(std::lround(parameters.max_features * std::pow(ratio, level) / sum)));
  return out;
}

cv::Rect innerOf(const cv::Mat& image) {
  return {kBorderPx, kBorderPx, image.cols - 2 * kBorderPx, image.rows - 2 * kBorderPx};
}

bool inAny(const std::vector<Box2>& boxes, double u, double v) {
  return std::any_of(boxes.begin(), boxes.end(), [&](const Box2& box) { return box.contains(u, v); });
}

/// Corners of one level, in px of the level.
std::vector<cv::KeyPoint> levelCorners(const Corners::Level& level, double scale,
                                       const std::vector<Box2>& excluded, int cell_px, std::size_t wanted) {
  std::vector<cv::KeyPoint> corners;
  std::copy_if(level.corners.begin(), level.corners.end(), std::back_inserter(corners),
               [&](const cv::KeyPoint& k) {
                 return !inAny(excluded, (k.pt.x + kBorderPx) * scale, (k.pt.y + kBorderPx) * scale);
               });
  corners = spread(corners, innerOf(level.image).size(), cell_px, wanted);
  for (auto& corner : corners) {
    corner.pt += cv::Point2f(kBorderPx, kBorderPx);
    corner.angle = patchAngle(level.image, cv::Point(corner.pt));
  }
  return corners;
}

/// Corners of all levels; pt = px of the level * scale, which is how cv::ORB addresses its own pyramid.
std::vector<cv::KeyPoint> pyramidCorners(const Corners& found, const std::vector<Box2>& excluded,
                                         const TrackingParameters& parameters) {
  const auto wanted = quotas(parameters);
  std::vector<cv::KeyPoint> all;
  for (std::size_t level = 0; level < found.levels.size(); ++level) {
    const double scale = std::pow(parameters.scale_factor, level);
    for (auto corner :
         levelCorners(found.levels[level], scale, excluded, parameters.cell_px, wanted[level])) {
      corner.octave = static_cast<int>(level);
      corner.size = static_cast<float>(31 * scale);
      corner.pt *= static_cast<float>(scale);
      all.push_back(corner);
    }
  }
  return all;
}

/// Depth at a pixel when the surface around it is smooth; 0 otherwise.
float steadyDepth(const Frame& frame, const cv::Point2f& p, const TrackingParameters& parameters) {
  const float center = frame.depthAt(p.x, p.y);
  if (!(center > 0) || center > parameters.max_depth_m) return 0;
  float low = center, high = center;
  for (int dv = -2; dv <= 2; dv += 2)
    for (int du = -2; du <= 2; du += 2) {
      const float z = frame.depthAt(p.x + du, p.y + dv);
      if (!(z > 0)) continue;
      low = std::min(low, z);
      high = std::max(high, z);
    }
  return high - low > parameters.max_depth_step * center ? 0 : center;
}

}  // namespace

Corners findCorners(const cv::Mat& gray, const TrackingParameters& parameters) {
  Corners out;
  cv::Mat image = gray;
  for (int level = 0; level < parameters.pyramid_levels; ++level) {
    const double scale = std::pow(parameters.scale_factor, level);
    const cv::Size size(cvRound(gray.cols / scale), cvRound(gray.rows / scale));
    if (std::min(size.width, size.height) <= 2 * kBorderPx) break;
    if (level > 0) {
      cv::Mat smaller;
      cv::resize(image, smaller, size, 0, 0, cv::INTER_LINEAR_EXACT);
      image = smaller;
    }
    std::vector<cv::KeyPoint> corners;
    cv::FAST(image(innerOf(image)), corners, parameters.fast_threshold, true);
    out.levels.push_back({image, std::move(corners)});
  }
  return out;
}

Features extractFeatures(const cv::Mat& gray, const Frame& frame, const std::vector<Box2>& excluded,
                         const TrackingParameters& parameters) {
  return extractFeatures(gray, findCorners(gray, parameters), frame, excluded, parameters);
}

Features extractFeatures(const cv::Mat& gray, const Corners& corners, const Frame& frame,
                         const std::vector<Box2>& excluded, const TrackingParameters& parameters) {
  Features features;
  std::vector<cv::KeyPoint> chosen = pyramidCorners(corners, excluded, parameters);
  cv::Mat descriptors;
  if (!chosen.empty())
    cv::ORB::create(parameters.max_features, static_cast<float>(parameters.scale_factor),
                    parameters.pyramid_levels, kBorderPx, 0, 2, cv::ORB::FAST_SCORE, 31,
                    parameters.fast_threshold)
        ->compute(gray, chosen, descriptors);
  features.descriptors.resize(chosen.size());
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    std::memcpy(features.descriptors[i].data(), descriptors.ptr(static_cast<int>(i)), 32);
    // Resizing maps pixel centres, not corners: undo the shift of coarse levels.
    const auto shift = static_cast<float>((std::pow(parameters.scale_factor, chosen[i].octave) - 1) / 2);
    features.places.push_back({chosen[i].pt + cv::Point2f(shift, shift), chosen[i].octave});
    features.depth.push_back(steadyDepth(frame, features.places.back().pt, parameters));
  }
  features.grid = FeatureGrid(features.places, gray.cols, gray.rows);
  return features;
}

}  // namespace roomgraph::tracking
