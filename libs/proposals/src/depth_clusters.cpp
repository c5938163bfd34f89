// SPDX-License-Identifier: BSD-3-Clause
// Voxel clustering of depth points, and choice of the cluster that explains the box.
#include "depth_clusters.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <nanoflann.hpp>
#include <tuple>

#include "plane_fit.h"
#include "roomgraph/core/order_statistics.h"

namespace roomgraph {
namespace {

constexpr double kShrink = 0.02;          // of the box's size, per side: its rim is background
constexpr double kUsualAspect = 0.45;     // width by height of a door that is seen from the front
constexpr double kAround = 0.45,
                 kGap =
                     0.06;  // of the box's size: how far beside it is looked, and what is left out at its rim
constexpr double kVoxel = 0.05;           // m
constexpr double kLinkDistance = 0.09;    // m, between voxels of one object
constexpr double kLinkPerSpacing = 2;     // added to it, on the distance of neighbouring samples …
constexpr double kLinkPerNoise = 2;       // … and on the depth noise
constexpr std::size_t kLeastPoints = 8;
// Points nearer to the ground are taken for floor: a constant, and a factor on the depth noise.
constexpr double kFloor_m = 0.03, kFloorPerNoise = 2;
// Points higher above the class's usual height do not belong to it: a constant, and standard deviations of the height.
constexpr double kCeiling_m = 0.1, kCeilingSigmas = 3;
// How well a cluster explains the box (`explains`). A cluster that hardly fills the box may still be the object; the
// other two favour the middle of the box and the nearer of two clusters.
constexpr double kFillOffset = 0.2, kOffsetWeight = 2, kRangeWeight_per_m = 0.15;
// A cluster that goes on beyond the box's sides is something else: how much less it explains the box when it does so
// everywhere. Points beside the box count that are this near to one in it, in pixels of the ring's width, and in
// distances of their lines of sight.
constexpr double kGoesOn = 0.7, kBesideWidths = 2.5, kSameSurface = 2.5;
constexpr double kRing = 0.05;  // of the box's size: width of the ring beyond it, and what is left out at its rim
constexpr double kLeastRing_px = 4;
constexpr double kLowEnd = 0.05, kHighEnd = 0.95;  // quantiles taken for the ends of a cluster
// Back rest: its least share of the main cluster's points, the quantile of its heights taken for its top, and how far
// beyond the object's mean half extent its middle may be.
constexpr double kBackRestShare = 0.05, kBackRestTop = 0.9, kBackRestSlack_m = 0.1;
constexpr double kPartSlack_m = 0.05;  // beyond half of the usual size, for other parts of the object

bool maskedOut(const Detection& detection, int u, int v) {
  if (detection.mask.empty()) return false;
  const Box2& box = detection.box;
  const int x = static_cast<int>((u - box.u_min) / box.width() * detection.mask.cols);
  const int y = static_cast<int>((v - box.v_min) / box.height() * detection.mask.rows);
  return x < 0 || y < 0 || x >= detection.mask.cols || y >= detection.mask.rows ||
         detection.mask.at<unsigned char>(y, x) == 0;
}

struct Voxel {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  std::vector<int> points;
  int cluster = -1;
  Eigen::Vector3d mean() const { return sum / static_cast<double>(points.size()); }
};

std::vector<Voxel> voxelize(const std::vector<MaskPoint>& points) {
  std::map<std::tuple<int, int, int>, Voxel> cells;  // ordered: the result does not depend on hashing
  for (int i = 0; i < static_cast<int>(points.size()); ++i) {
    const Eigen::Vector3d& p = points[i].in_ground;
    const auto cell = [](double x) { return static_cast<int>(std::floor(x / kVoxel)); };
    Voxel& voxel = cells[{cell(p.x()), cell(p.y()), cell(p.z())}];
    voxel.sum += p;
    voxel.points.push_back(i);
  }
  std::vector<Voxel> out;
  for (auto& [key, voxel] : cells) out.push_back(std::move(voxel));
  return out;
}

struct Cloud {
  std::vector<Eigen::Vector3d> points;
  std::size_t kdtree_get_point_count() const { return points.size(); }
  double kdtree_get_pt(std::size_t i, std::size_t axis) const {
    return points[i][static_cast<Eigen::Index>(axis)];
  }
  template <class B>
  bool kdtree_get_bbox(B&) const {
    return false;
  }
};

// Connected components of voxels closer than `distance`; returns their number.
int cluster(std::vector<Voxel>& voxels, double distance) {
  Cloud cloud;
  for (const Voxel& voxel : voxels) cloud.points.push_back(voxel.mean());
  using Tree = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, Cloud>, Cloud, 3>;
  Tree tree(3, cloud, {16});
  int count = 0;
  std::vector<std::pair<std::uint32_t, double>> found;
  for (std::size_t seed = 0; seed < voxels.size(); ++seed) {
    if (voxels[seed].cluster >= 0) continue;
    std::vector<std::size_t> open{seed};
    voxels[seed].cluster = count;
    while (!open.empty()) {
      const std::size_t current = open.back();
      open.pop_back();
      tree.radiusSearch(cloud.points[current].data(), distance * distance, found, {32, 0.f, false});
      for (const auto& [index, squared] : found)
        if (voxels[index].cluster < 0) {
          voxels[index].cluster = count;
          open.push_back(index);
        }
    }
    ++count;
  }
  return count;
}

std::vector<DepthMask> clusters(const std::vector<MaskPoint>& points, double distance) {
  std::vector<Voxel> voxels = voxelize(points);
  std::vector<DepthMask> out(cluster(voxels, distance));
  for (const Voxel& voxel : voxels)
    for (const int i : voxel.points) out[voxel.cluster].points.push_back(points[i]);
  return out;
}

Box2 boundsOf(const std::vector<MaskPoint>& points) {
  Box2 bounds{1e9, 1e9, -1e9, -1e9};
  for (const auto& p : points)
    bounds = {std::min(bounds.u_min, p.u), std::min(bounds.v_min, p.v), std::max(bounds.u_max, p.u),
              std::max(bounds.v_max, p.v)};
  return bounds;
}

// Larger for a cluster that has many points, fills the box, is in its middle, and is near (what is behind cannot hide
// the object).
double explains(const DepthMask& cluster, std::size_t total, const Box2& box) {
  double range = 0;
  Eigen::Vector2d offset = Eigen::Vector2d::Zero();
  for (const auto& p : cluster.points) {
    range += p.in_ground.head<2>().norm();
    offset +=
        (Eigen::Vector2d(p.u, p.v) - box.center()).cwiseQuotient(Eigen::Vector2d(box.width(), box.height()));
  }
  const double n = static_cast<double>(cluster.points.size());
  const double share = n / static_cast<double>(total), fill = iou(boundsOf(cluster.points), box);
  return std::sqrt(share) * (kFillOffset + fill) * std::exp(-kOffsetWeight * (offset / n).squaredNorm()) /
         (1 + kRangeWeight_per_m * range / n);
}

double middleRange(const DepthMask& cluster) {
  std::vector<double> ranges;
  for (const auto& p : cluster.points) ranges.push_back(p.in_ground.norm());
  return quantile(std::move(ranges), 0.5);
}

// Share of the points beyond the box beside a cluster that continue it: an object ends at the sides of its box. What is
// farther than a cuboid's middle may be the wall that it stands at.
double goesOn(const DepthMask& cluster, const Surroundings& ring, const ObjectModel& model, double focal_px) {
  const double farthest = model.nominal().kind == ShapeKind::kCylinder ? std::numeric_limits<double>::infinity()
                                                                       : middleRange(cluster);
  int beside = 0, same = 0;
  for (const auto& out : ring.points) {
    bool near = false, continued = false;
    for (const auto& in : cluster.points) {
      const double pixels = std::max(std::abs(in.u - out.u), std::abs(in.v - out.v));
      if (pixels > kBesideWidths * ring.width_px) continue;
      near = true;
      const double range = in.in_ground.norm();
      const double reach = kSameSurface * pixels * range / focal_px + kLinkPerNoise * depthSigma(range);
      continued |= out.in_ground.norm() < farthest && (in.in_ground - out.in_ground).norm() < reach;
    }
    beside += near;
    same += continued;
  }
  return beside > 0 ? static_cast<double>(same) / beside : 0;
}

Eigen::Vector2d middleOf(const DepthMask& mask) {
  std::vector<double> x, y;
  for (const auto& p : mask.points) {
    x.push_back(p.in_ground.x());
    y.push_back(p.in_ground.y());
  }
  return {(quantile(x, kLowEnd) + quantile(x, kHighEnd)) / 2, (quantile(y, kLowEnd) + quantile(y, kHighEnd)) / 2};
}

// Whether a cluster is the object's back rest, separated from the seat by a surface seen at a grazing angle.
bool isBackRest(const DepthMask& part, const Eigen::Vector2d& middle, std::size_t main_size,
            const ObjectModel& model) {
  if (model.frontRule() != FrontRule::kHighBack ||
      part.points.size() < kBackRestShare * static_cast<double>(main_size))
    return false;
  std::vector<double> heights;
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  for (const auto& p : part.points) {
    heights.push_back(p.in_ground.z());
    mean += p.in_ground.head<2>() / static_cast<double>(part.points.size());
  }
  return quantile(heights, kBackRestTop) < model.height_m + model.height_sigma_m &&
         (mean - middle).norm() < (model.width_m + model.depth_m) / 4 + kBackRestSlack_m;
}

// Adds the points of other clusters that lie within the usual size around the main cluster's middle.
void takeInParts(DepthMask& main, const std::vector<DepthMask>& others, std::size_t skip,
                 const ObjectModel& model) {
  const Eigen::Vector2d middle = middleOf(main);
  const std::size_t main_size = main.points.size();
  const double reach = std::min(model.width_m, model.depth_m) / 2 + kPartSlack_m;
  for (std::size_t k = 0; k < others.size(); ++k) {
    if (k == skip) continue;
    const bool whole = isBackRest(others[k], middle, main_size, model);
    for (const auto& p : others[k].points)
      if (whole || (p.in_ground.head<2>() - middle).norm() < reach) main.points.push_back(p);
  }
}

// Pixels from one sample to the next, for at most about so many of them.
int strideOver(const Box2& box, int max_points) {
  return std::max(1, static_cast<int>(std::ceil(std::sqrt(box.area() / max_points))));
}

template <class Wanted>
DepthMask samplePixels(const Frame& frame, const Box2& box, int stride, const Pose3& ground_from_camera,
                       const Wanted& wanted) {
  DepthMask out;
  if (!frame.hasDepth() || box.empty()) return out;
  int tried = 0;
  for (int v = static_cast<int>(box.v_min); v < static_cast<int>(box.v_max); v += stride)
    for (int u = static_cast<int>(box.u_min); u < static_cast<int>(box.u_max); u += stride) {
      if (!wanted(u, v)) continue;
      ++tried;
      const float z = frame.depth.at<float>(v, u);
      if (!(z > 0) || !std::isfinite(z)) continue;
      out.points.push_back({static_cast<double>(u), static_cast<double>(v),
                            ground_from_camera * frame.camera.backProject(u, v, z)});
    }
  out.valid_ratio = tried > 0 ? static_cast<double>(out.points.size()) / tried : 0;
  return out;
}

}  // namespace

DepthMask sampleBox(const Frame& frame, const Detection& detection, const Pose3& ground_from_camera,
                    int max_points) {
  const Box2 box = clipped(detection.box, frame.depth.cols, frame.depth.rows);
  const double du = kShrink * box.width(), dv = kShrink * box.height();
  const Box2 inner{box.u_min + du, box.v_min + dv, box.u_max - du, box.v_max - dv};
  const auto stride = strideOver(box, max_points);
  return samplePixels(frame, inner, stride, ground_from_camera,
                      [&](int u, int v) { return !maskedOut(detection, u, v); });
}

DepthMask sampleAround(const Frame& frame, const Box2& box, const Pose3& ground_from_camera, int max_points) {
  // A narrow box may be of a leaf that is seen from the side: there is no less wall beside it.
  const double du = kAround * std::max(box.width(), kUsualAspect * box.height()), dv = kAround * box.height();
  const Box2 outer = clipped({box.u_min - du, box.v_min - dv, box.u_max + du, box.v_max}, frame.depth.cols,
                             frame.depth.rows);
  const double gap_u = kGap * box.width(), gap_v = kGap * box.height();
  const Box2 inner{box.u_min - gap_u, box.v_min - gap_v, box.u_max + gap_u, box.v_max};
  return samplePixels(frame, outer, strideOver(outer, max_points), ground_from_camera,
                      [&](int u, int v) { return !inner.contains(u, v); });
}

Surroundings sampleRing(const Frame& frame, const Box2& box, const Pose3& ground_from_camera, int max_points) {
  const double width = std::max(kLeastRing_px, kRing * std::max(box.width(), box.height()));
  const auto grown = [&](double by) {
    return clipped({box.u_min - by, box.v_min - by, box.u_max + by, box.v_max + by}, frame.depth.cols, frame.depth.rows);
  };
  const Box2 outer = grown(2 * width), inner = grown(width);
  Surroundings out;
  out.width_px = width;
  out.points = samplePixels(frame, outer, strideOver(outer, max_points), ground_from_camera,
                            [&](int u, int v) { return !inner.contains(u, v); })
                   .points;
  std::erase_if(out.points, [](const MaskPoint& p) {
    return p.in_ground.z() < kFloor_m + kFloorPerNoise * depthSigma(p.in_ground.norm());
  });
  return out;
}

std::vector<DepthMask> explanations(const DepthMask& all, const Surroundings& ring, const Box2& box,
                                    const ObjectModel& model, double focal_px, int max_count) {
  std::vector<DepthMask> out;
  const double ceiling = model.rests_on_ground
                             ? model.height_m + kCeilingSigmas * model.height_sigma_m + kCeiling_m
                             : std::numeric_limits<double>::infinity();
  std::vector<MaskPoint> standing;
  std::vector<double> ranges;
  for (const auto& p : all.points) {
    const double range = p.in_ground.norm(), floor = kFloor_m + kFloorPerNoise * depthSigma(range);
    if (p.in_ground.z() < floor || p.in_ground.z() > ceiling) continue;
    standing.push_back(p);
    ranges.push_back(range);
  }
  if (standing.size() < kLeastPoints) return out;
  const double spacing = std::sqrt(box.area() / static_cast<double>(all.points.size())) / focal_px;
  const double range = quantile(ranges, 0.5);
  const auto parts =
      clusters(standing, kLinkDistance + kLinkPerSpacing * spacing * range + kLinkPerNoise * depthSigma(range));
  std::vector<double> beyond;
  std::vector<std::pair<double, std::size_t>> order;
  for (std::size_t k = 0; k < parts.size(); ++k) {
    beyond.push_back(goesOn(parts[k], ring, model, focal_px));
    order.emplace_back(-explains(parts[k], standing.size(), box) * (1 - kGoesOn * beyond[k]), k);
  }
  std::sort(order.begin(), order.end());
  for (const auto& [score, k] : order) {
    if (static_cast<int>(out.size()) == max_count) break;
    DepthMask mask = parts[k];
    mask.valid_ratio = all.valid_ratio;
    mask.goes_on = beyond[k];
    takeInParts(mask, parts, k, model);
    if (mask.points.size() >= kLeastPoints) out.push_back(mask);
  }
  return out;
}

}  // namespace roomgraph
