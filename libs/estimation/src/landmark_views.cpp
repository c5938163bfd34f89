// SPDX-License-Identifier: BSD-3-Clause
// Grouping of sightings by direction, end in view and visit; their means and weights.
#include "landmark_views.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <optional>

#include "direction_bin.h"
#include "roomgraph/geometry/covariance.h"
#include "roomgraph/geometry/shape_math.h"
#include "sighting_mean.h"
#include "size_mean.h"

namespace roomgraph {
namespace {

// Of the mean of sightings, in widths of the loss of one of them: what is cut off is another depth, not scatter.
constexpr double kMeanWidth = 3;
// Landmarks of the graph that stand for views; the map's own never get that far.
constexpr std::int64_t kFirstView = 1'000'000'000;
constexpr int kDirections = 1024;      // more than there are of the least landmark_view_rad
constexpr int kEnds = 3;               // none, left, right
constexpr double kLeastWeight = 1e-9;  // a view without weight would leave its place undetermined
constexpr double kVisitPause_s = 3;    // an object not seen for so long begins a new visit
// How far the middle may be from where the end that is held fast puts it for the usual width, for a view to tell of that end
// alone: a sofa's is so uncertain, a door's is not.
constexpr double kUnknown_m = 0.075;
constexpr double kLeastPlaceSigma_m = 0.01;  // of a place, however well the size were known

LandmarkFactor inWorld(LandmarkFactor sighting, const Pose3& world_from_robot) {
  sighting.position_in_robot = world_from_robot * sighting.position_in_robot;
  sighting.yaw_in_robot = wrapAngle(sighting.yaw_in_robot + planarPart(world_from_robot).yaw);
  sighting.covariance = rotateCovariance(sighting.covariance, world_from_robot.linear());
  return sighting;
}

LandmarkFactor seenFrom(LandmarkFactor in_world, const KeyPose& node) {
  in_world.node = node.id;
  in_world.position_in_robot = node.world_from_robot.inverse() * in_world.position_in_robot;
  in_world.yaw_in_robot = wrapAngle(in_world.yaw_in_robot - planarPart(node.world_from_robot).yaw);
  in_world.covariance = rotateCovariance(in_world.covariance, node.world_from_robot.linear().transpose());
  return in_world;
}

// The yaw that most sightings say, by their weights: one that took width for depth may claim to be
// sure, one of a leaf that may be open does not. Axes first, by doubled angles in which front and back are
// one. Nothing when no sighting has a yaw.
constexpr double kSurestYaw = 0.1;  // rad^2; no sighting has a louder voice than one of this variance
std::optional<double> votedYaw(const SightingsByNode& sightings, const KeyPoses& poses, double sigma_share) {
  std::complex<double> doubled = 0, single = 0;
  for (const auto& [id, group] : sightings) {
    const double node_yaw = planarPart(poses.node(id).world_from_robot).yaw;
    for (const auto& [s, proposal, size_weight] : group) {
      if (!s.has_yaw) continue;
      const double vote = s.weight / (kSurestYaw + sigma_share * sigma_share * s.covariance(3, 3));
      doubled += std::polar(vote, 2 * (node_yaw + s.yaw_in_robot));
      single += std::polar(vote, node_yaw + s.yaw_in_robot);
    }
  }
  if (std::abs(doubled) <= 0) return std::nullopt;
  const double axis = std::arg(doubled) / 2;
  return std::real(single * std::polar(1.0, -axis)) < 0 ? wrapAngle(axis + std::numbers::pi) : axis;
}

bool isAcross(double difference_rad) {
  return std::abs(std::sin(difference_rad)) > std::numbers::sqrt2 / 2;
}

// The yaw of the other direction is reversed, one across does not measure the yaw.
LandmarkFactor withYawNear(double yaw, LandmarkFactor in_world) {
  if (std::abs(wrapAngle(in_world.yaw_in_robot - yaw)) > std::numbers::pi / 2)
    in_world.yaw_in_robot = wrapAngle(in_world.yaw_in_robot + std::numbers::pi);
  in_world.has_yaw &= !isAcross(in_world.yaw_in_robot - yaw);
  return in_world;
}

// A sighting as a view takes it.
struct EndSeen {
  LandmarkFactor in_world;  // at the landmark's size, its yaw near the landmark's
  PlaceBySize lever = PlaceBySize::Zero();
  std::optional<int> end;          // that it holds fast: 1 or -1, 0 for both or neither; nothing when it has not the landmark's yaw
  const Proposal* size = nullptr;  // that measured it; null: took width for depth
  double size_weight = 0;
};

using Visit = std::vector<LandmarkFactor>;  // sightings in a row, placed in world

// One end, from one direction.
struct View {
  std::map<int, Visit> visits;
  OffsetMean offset;
};

// What was seen from one direction.
struct Direction {
  std::map<int, View> ends;
  SizeMean size;
  NodeId last;    // key pose that saw it
  int visit = 0;  // the latest
};

// Where the width hardly varies, either end tells the middle.
int endOf(const PlaceBySize& lever, const ObjectModel& usual) {
  const double by_width_m = lever(1, 0) * usual.sizeSigma()[0];
  return std::abs(by_width_m) < kUnknown_m ? 0 : by_width_m > 0 ? 1 : -1;
}

// `sighting`: in world. `yaw`: the landmark's.
EndSeen endSeen(const LandmarkSighting& sighting, const Landmark& landmark, const ObjectModel* usual, double yaw,
                const BackendOptions& options) {
  const Proposal& proposal = *sighting.proposal;
  const double turned = sighting.factor.yaw_in_robot - yaw;
  EndSeen out{sighting.factor};
  if (usual && !(proposal.has_yaw && isAcross(turned))) {
    out.size = &proposal;
    out.size_weight = sighting.size_weight;
    if (options.object_views && landmark.has_yaw && proposal.has_yaw) {
      out.in_world = atSize(landmark.shape, sighting, *usual);
      // A size that is not estimated stays as uncertain as it is.
      if (!options.object_sizes) out.in_world.covariance = sighting.factor.covariance;
      out.lever = Eigen::Rotation2Dd(turned).toRotationMatrix() * proposal.place_by_size;
      out.end = endOf(out.lever, *usual);
    }
  }
  out.in_world = withYawNear(yaw, out.in_world);
  out.in_world.covariance *= options.landmark_sigma_share * options.landmark_sigma_share;
  return out;
}

// By ends; what tells none of them goes with the end that tells most.
std::map<int, std::vector<EndSeen>> byEnds(const std::vector<EndSeen>& seen) {
  std::map<int, double> weights;
  for (const EndSeen& s : seen)
    if (s.end) weights[*s.end] += shareOfPlace(s.in_world);
  const auto most = std::max_element(weights.begin(), weights.end(),
                                     [](const auto& a, const auto& b) { return a.second < b.second; });
  std::map<int, std::vector<EndSeen>> out;
  for (const EndSeen& s : seen) out[s.end.value_or(most == weights.end() ? 0 : most->first)].push_back(s);
  return out;
}

// Adds what one key pose saw of one end.
void addToDirections(const std::vector<EndSeen>& seen, int end, const ObjectModel* usual, const KeyPoses& poses,
                     const BackendOptions& options, std::map<int, Direction>& directions) {
  std::vector<LandmarkFactor> factors;
  for (const EndSeen& s : seen) factors.push_back(s.in_world);
  const KeyPose& node = poses.node(factors.front().node);
  const LandmarkFactor sighting = meanSighting(factors, kMeanWidth * options.landmark_robust_width);
  if (sighting.weight < kLeastWeight) return;
  Direction& from = directions[directionOf(sighting.position_in_robot, node, options.landmark_view_rad)];
  // A robot that stands still makes few key poses: a visit ends only when key poses in between do not see
  // the object.
  if (from.last.valid() && node.id.value - from.last.value > 1 && node.t - poses.node(from.last).t > kVisitPause_s) ++from.visit;
  from.last = node.id;
  View& view = from.ends[end];
  view.visits[from.visit].push_back(sighting);
  for (const EndSeen& s : seen) {
    view.offset.add(s.lever, shareOfPlace(s.in_world));
    if (s.size) from.size.add(*s.size, *usual, s.size_weight);
  }
}

std::map<int, Direction> directionsOf(const SightingsByNode& sightings, const Landmark& landmark, const ObjectModel* usual,
                                      const KeyPoses& poses, double yaw, const BackendOptions& options) {
  std::map<int, Direction> directions;
  for (const auto& [id, group] : sightings) {
    std::vector<EndSeen> seen;
    for (LandmarkSighting sighting : group) {
      sighting.factor = inWorld(sighting.factor, poses.node(id).world_from_robot);
      seen.push_back(endSeen(sighting, landmark, usual, yaw, options));
    }
    for (const auto& [end, of_end] : byEnds(seen)) addToDirections(of_end, end, usual, poses, options, directions);
  }
  return directions;
}

// `visits`: mean sightings in world.
LandmarkViewFactor sharedError(const std::vector<LandmarkFactor>& visits, const BackendOptions& options) {
  const LandmarkFactor mean = meanSighting(visits, kMeanWidth * options.landmark_robust_width);
  return {.landmark = mean.landmark,
          .has_yaw = mean.has_yaw,
          .covariance = options.landmark_repeating_share * mean.covariance,
          .weight = mean.weight,
          .robust_width = options.landmark_robust_width};
}

// The same whenever the graph is built again.
LandmarkId viewId(LandmarkId landmark, int direction, int end) {
  return LandmarkId{kFirstView + (landmark.value * kDirections + kDirections / 2 + direction) * kEnds + end + 1};
}

// `id`: of the view.
void addView(LandmarkId id, const View& view, const Landmark& landmark, double yaw, const KeyPoses& poses,
             const BackendOptions& options, ObjectFactors& out) {
  std::vector<LandmarkFactor> visits;
  for (const auto& [number, visit] : view.visits) {
    visits.push_back(meanSighting(visit, kMeanWidth * options.landmark_robust_width));
    LandmarkFactor sighting = seenFrom(visits.back(), poses.node(visit[visit.size() / 2].node));
    sighting.robust_width = options.landmark_robust_width;
    if (options.object_views) {
      sighting.landmark = id;
      sighting.covariance *= 1 - options.landmark_repeating_share;
    }
    out.sightings.push_back(sighting);
  }
  if (!options.object_views) return;
  out.views[id] = {landmark.position, yaw, landmark.shape};
  out.shared_errors.push_back(sharedError(visits, options));
  out.shared_errors.back().view = id;
  if (landmark.has_yaw) view.offset.apply(landmark.shape, out.shared_errors.back());
}

void addSizes(const SizeMean& size, LandmarkId landmark, ObjectFactors& out) {
  if (size.empty()) return;
  out.sizes.push_back(size.factor(landmark));
  if (const auto least = size.leastSize(landmark)) out.sizes.push_back(*least);
}

}  // namespace

int directionOf(const Eigen::Vector3d& place, const KeyPose& node, double angle_rad) {
  return directionBin((place - node.world_from_robot.translation()).head<2>(), angle_rad);
}

LandmarkFactor atSize(const ObjectShape& shape, const LandmarkSighting& sighting, const ObjectModel& usual) {
  LandmarkFactor out = sighting.factor;
  const Proposal& proposal = *sighting.proposal;
  const Eigen::Vector3d longer = sizeOf(shape) - sizeOf(proposal.shape);
  out.position_in_robot.head<2>() += Eigen::Rotation2Dd(out.yaw_in_robot) * (proposal.place_by_size * longer);
  auto place = out.covariance.topLeftCorner<2, 2>();
  place -= placeSpread(proposal.place_by_size, out.yaw_in_robot, proposal.size_information, usual.sizeSigma());
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(place);
  const Eigen::Vector2d least = Eigen::Vector2d::Constant(kLeastPlaceSigma_m * kLeastPlaceSigma_m);
  place = axes.eigenvectors() * axes.eigenvalues().cwiseMax(least).asDiagonal() * axes.eigenvectors().transpose();
  return out;
}

bool addViews(const SightingsByNode& sightings, const Landmark& landmark, const ObjectModel* usual, const KeyPoses& poses,
              const BackendOptions& options, ObjectFactors& out) {
  const double yaw = votedYaw(sightings, poses, options.landmark_sigma_share).value_or(landmark.yaw);
  const auto directions = directionsOf(sightings, landmark, usual, poses, yaw, options);
  for (const auto& [direction, from] : directions) {
    for (const auto& [end, view] : from.ends)
      addView(viewId(landmark.id, direction, end), view, landmark, yaw, poses, options, out);
    if (options.object_sizes) addSizes(from.size, landmark.id, out);
  }
  if (directions.empty()) return false;
  out.yaws[landmark.id] = yaw;
  if (options.object_sizes && usual) {
    out.sizes.push_back(leastOfClass(landmark.id, *usual));
    out.sizes.push_back(sizePrior(landmark.id, *usual));
  }
  return true;
}

}  // namespace roomgraph
