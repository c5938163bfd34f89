// SPDX-License-Identifier: BSD-3-Clause
// Projection search with pyramid level prediction, and mutual best matches with ratio test.
#include "matcher.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <optional>

namespace roomgraph::tracking {
namespace {

constexpr double kMaxViewAngleCosine =
    0.5;  // descriptors do not survive a change of view of more than 60 degrees

struct Expected {
  Eigen::Vector2d pixel;
  int octave;
};

/// Pixel and pyramid level at which a point should appear; nothing when it is out of view or seen too
/// obliquely.
std::optional<Expected> expect(const MapPoint& point, const ProjectionSearch& search,
                               const TrackingParameters& parameters) {
  const Eigen::Vector3d p = search.camera_from_odom * point.position;
  if (p.z() < 0.05) return std::nullopt;
  const Eigen::Vector2d pixel = search.camera.project(p);
  if (!search.camera.sees(pixel.x(), pixel.y())) return std::nullopt;
  const Eigen::Vector3d ray = search.camera_from_odom.linear().transpose() * p.normalized();
  if (ray.dot(point.direction) < kMaxViewAngleCosine) return std::nullopt;
  const double levels = std::log(point.distance / p.norm()) / std::log(parameters.scale_factor);
  const int octave =
      std::clamp(point.octave + static_cast<int>(std::lround(levels)), 0, parameters.pyramid_levels - 1);
  return Expected{pixel, octave};
}

struct Best {
  int feature = -1, distance = 256, second = 256;
};

Best closest(const MapPoint& point, const Expected& expected, const Features& features,
             const std::vector<std::int64_t>& taken, const std::vector<int>& nearby) {
  Best best;
  for (const int i : nearby) {
    const auto k = static_cast<std::size_t>(i);
    if (taken[k] >= 0 || std::abs(features.places[k].octave - expected.octave) > 1) continue;
    const int distance = hammingDistance(point.descriptor, features.descriptors[k]);
    if (distance < best.distance) {
      best.second = best.distance;
      best = {i, distance, best.second};
    } else {
      best.second = std::min(best.second, distance);
    }
  }
  return best;
}

using Words = std::array<std::uint64_t, 4>;
static_assert(sizeof(Words) == sizeof(Descriptor));

// The loop is written once for each instruction set: what is inlined into a function takes its target.
[[gnu::always_inline]] inline int differingBits(const Descriptor& a, const Descriptor& b) {
  const auto x = std::bit_cast<Words>(a), y = std::bit_cast<Words>(b);
  int bits = 0;
  for (std::size_t i = 0; i < x.size(); ++i) bits += std::popcount(x[i] ^ y[i]);
  return bits;
}

[[gnu::always_inline]] inline Best nearestByBits(const Descriptor& descriptor, const std::vector<Descriptor>& all) {
  Best best;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const int distance = differingBits(descriptor, all[i]);
    if (distance < best.distance)
      best = {static_cast<int>(i), distance, best.distance};
    else
      best.second = std::min(best.second, distance);
  }
  return best;
}

#if defined(__x86_64__)
// Every processor since 2008 counts bits by an instruction, which the baseline of x86-64 does not have.
[[gnu::target("popcnt")]] int countedByInstruction(const Descriptor& a, const Descriptor& b) { return differingBits(a, b); }
[[gnu::target("popcnt")]] Best nearestByInstruction(const Descriptor& descriptor, const std::vector<Descriptor>& all) {
  return nearestByBits(descriptor, all);
}
const bool kHasInstruction = __builtin_cpu_supports("popcnt");
#endif

/// The nearest of `all` and the distance of the second nearest; of equally near ones the first.
Best nearest(const Descriptor& descriptor, const std::vector<Descriptor>& all) {
#if defined(__x86_64__)
  if (kHasInstruction) return nearestByInstruction(descriptor, all);
#endif
  return nearestByBits(descriptor, all);
}

}  // namespace

int hammingDistance(const Descriptor& a, const Descriptor& b) {
#if defined(__x86_64__)
  if (kHasInstruction) return countedByInstruction(a, b);
#endif
  return differingBits(a, b);
}

std::vector<PointMatch> ProjectionSearch::match(const std::vector<std::int64_t>& ids,
                                                const Features& features,
                                                const std::vector<std::int64_t>& taken,
                                                const TrackingParameters& parameters,
                                                std::vector<std::int64_t>* in_view) const {
  std::vector<PointMatch> by_feature(features.size());
  std::vector<int> distances(features.size(), 256), nearby;
  for (const auto id : ids) {
    const MapPoint& point = map.point(id);
    const auto expected = point.erased ? std::nullopt : expect(point, *this, parameters);
    if (!expected) continue;
    if (in_view) in_view->push_back(id);
    nearby.clear();
    const double radius = radius_px * std::pow(parameters.scale_factor, expected->octave);
    features.grid.query(expected->pixel.x(), expected->pixel.y(), radius, nearby);
    const Best best = closest(point, *expected, features, taken, nearby);
    if (best.feature < 0 || best.distance > parameters.max_hamming ||
        best.distance > parameters.match_ratio * best.second)
      continue;
    const auto k = static_cast<std::size_t>(best.feature);
    if (best.distance >= distances[k]) continue;
    distances[k] = best.distance;
    by_feature[k] = {id, best.feature};
  }
  std::erase_if(by_feature, [](const PointMatch& m) { return m.feature < 0; });
  return by_feature;
}

std::vector<std::pair<int, int>> matchDescriptors(const std::vector<Descriptor>& a,
                                                  const std::vector<Descriptor>& b,
                                                  const TrackingParameters& parameters) {
  std::vector<std::pair<int, int>> out;
  if (a.size() < 2 || b.size() < 2) return out;
  std::vector<int> best_a(b.size(), -1), distances(b.size(), 257);
  for (std::size_t i = 0; i < a.size(); ++i) {
    const Best best = nearest(a[i], b);
    if (best.distance > parameters.max_hamming || best.distance > parameters.match_ratio * best.second) continue;
    const auto j = static_cast<std::size_t>(best.feature);
    if (best.distance >= distances[j]) continue;
    distances[j] = best.distance;
    best_a[j] = static_cast<int>(i);
  }
  for (std::size_t j = 0; j < b.size(); ++j)
    if (best_a[j] >= 0) out.emplace_back(best_a[j], static_cast<int>(j));
  return out;
}

}  // namespace roomgraph::tracking
