// SPDX-License-Identifier: BSD-3-Clause
// Grouping of sightings by direction, end in view and visit; their means and weights.
#include "landmark_views.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <optional>

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
constexpr double kLeastSigma_m = 0.01;  // of a place, however well the size were known

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
LandmarkFactor withYawNear(double yaw_in_robot, LandmarkFactor sighting) {
  if (std::abs(wrapAngle(sighting.yaw_in_robot - yaw_in_robot)) > std::numbers::pi / 2)
    sighting.yaw_in_robot = wrapAngle(sighting.yaw_in_robot + std::numbers::pi);
  sighting.has_yaw &= !isAcross(sighting.yaw_in_robot - yaw_in_robot);
  return sighting;
}

// The end of the landmark that a view holds fast: 0 when it is both or neither, else the sign of the lever.
struct ViewKey {
  int direction = 0, end = 0;
  auto operator<=>(const ViewKey&) const = default;
};

using Visit = std::vector<LandmarkFactor>;  // sightings in a row, placed in world

struct View {
  std::vector<Visit> visits;
  SizeMean size;
  OffsetMean offset;
};

// A sighting as the view of one end takes it.
struct EndSeen {
  LandmarkFactor factor;  // at the landmark's size, its yaw near the landmark's
  PlaceBySize lever = PlaceBySize::Zero();
  int end = 0;                     // see ViewKey
  const Proposal* size = nullptr;  // that measured it; null: took width for depth
  double size_weight = 0;
};

// Where the width hardly varies, either end tells the middle.
int endOf(const PlaceBySize& lever, const ObjectModel& usual) {
  const double by_width_m = lever(1, 0) * usual.width_sigma_m;
  return std::abs(by_width_m) < kUnknown_m ? 0 : by_width_m > 0 ? 1 : -1;
}

EndSeen endSeen(const LandmarkSighting& sighting, const Landmark& landmark, const ObjectModel* usual, double yaw_in_robot,
                double sigma_share) {
  const double turned = sighting.factor.yaw_in_robot - yaw_in_robot;
  const bool has_yaw = sighting.proposal->has_yaw, measures = usual && !(has_yaw && isAcross(turned));
  EndSeen out{sighting.factor};
  if (measures) {
    out.size = sighting.proposal;
    out.size_weight = sighting.size_weight;
  }
  if (measures && has_yaw && landmark.has_yaw) {
    out.factor = atSize(landmark.shape, sighting, *usual);
    out.lever = Eigen::Rotation2Dd(turned).toRotationMatrix() * sighting.proposal->place_by_size;
    out.end = endOf(out.lever, *usual);
  }
  out.factor = withYawNear(yaw_in_robot, out.factor);
  out.factor.covariance *= sigma_share * sigma_share;
  return out;
}

// Adds what one key pose saw of one end.
void addToViews(const std::vector<EndSeen>& seen, int end, const ObjectModel* usual, const KeyPoses& poses,
                const BackendOptions& options, std::map<ViewKey, View>& views) {
  std::vector<LandmarkFactor> factors;
  for (const EndSeen& s : seen) factors.push_back(s.factor);
  const KeyPose& node = poses.node(factors.front().node);
  const LandmarkFactor sighting =
      inWorld(meanSighting(factors, kMeanWidth * options.landmark_robust_width), node.world_from_robot);
  if (sighting.weight < kLeastWeight) return;
  View& view = views[{directionOf(sighting.position_in_robot, node, options.landmark_view_rad), end}];
  // A robot that stands still makes few key poses: a visit ends only when key poses in between do not see
  // the object.
  const bool gone = view.visits.empty() || (node.id.value - view.visits.back().back().node.value > 1 &&
                                            node.t - poses.node(view.visits.back().back().node).t > kVisitPause_s);
  if (gone) view.visits.emplace_back();
  view.visits.back().push_back(sighting);
  for (const EndSeen& s : seen) {
    view.offset.add(s.lever, shareOfPlace(s.factor));
    if (s.size) view.size.add(*s.size, *usual, s.size_weight);
  }
}

std::map<ViewKey, View> viewsOf(const SightingsByNode& sightings, const Landmark& landmark, const ObjectModel* usual,
                                const KeyPoses& poses, double yaw, const BackendOptions& options) {
  std::map<ViewKey, View> views;
  for (const auto& [id, group] : sightings) {
    const double yaw_in_robot = yaw - planarPart(poses.node(id).world_from_robot).yaw;
    std::map<int, std::vector<EndSeen>> ends;
    for (const LandmarkSighting& sighting : group) {
      const EndSeen seen = endSeen(sighting, landmark, usual, yaw_in_robot, options.landmark_sigma_share);
      ends[seen.end].push_back(seen);
    }
    for (const auto& [end, seen] : ends) addToViews(seen, end, usual, poses, options, views);
  }
  return views;
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
LandmarkId viewId(LandmarkId landmark, const ViewKey& key) {
  return LandmarkId{kFirstView + (landmark.value * kDirections + kDirections / 2 + key.direction) * kEnds + key.end + 1};
}

}  // namespace

int directionOf(const Eigen::Vector3d& place, const KeyPose& node, double angle_rad) {
  const Eigen::Vector3d ray = place - node.world_from_robot.translation();
  return static_cast<int>(std::floor(std::atan2(ray.y(), ray.x()) / angle_rad));
}

LandmarkFactor atSize(const ObjectShape& shape, const LandmarkSighting& sighting, const ObjectModel& usual) {
  LandmarkFactor out = sighting.factor;
  const Proposal& proposal = *sighting.proposal;
  const PlaceBySize lever = Eigen::Rotation2Dd(out.yaw_in_robot).toRotationMatrix() * proposal.place_by_size;
  out.position_in_robot.head<2>() += lever * (sizeOf(shape) - sizeOf(proposal.shape));
  auto place = out.covariance.topLeftCorner<2, 2>();
  place -= placeSpread(lever, proposal.size_information, usual.sizeSigma());
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(place);
  const Eigen::Vector2d least = Eigen::Vector2d::Constant(kLeastSigma_m * kLeastSigma_m);
  place = axes.eigenvectors() * axes.eigenvalues().cwiseMax(least).asDiagonal() * axes.eigenvectors().transpose();
  return out;
}

bool addViews(const SightingsByNode& sightings, const Landmark& landmark, const ObjectModel* usual, const KeyPoses& poses,
              const BackendOptions& options, ObjectFactors& out) {
  const double yaw = votedYaw(sightings, poses, options.landmark_sigma_share).value_or(landmark.yaw);
  const auto views = viewsOf(sightings, landmark, usual, poses, yaw, options);
  for (const auto& [key, view] : views) {
    std::vector<LandmarkFactor> visits;
    const LandmarkId id = viewId(landmark.id, key);
    for (const Visit& visit : view.visits) {
      visits.push_back(meanSighting(visit, kMeanWidth * options.landmark_robust_width));
      LandmarkFactor sighting = seenFrom(visits.back(), poses.node(visit[visit.size() / 2].node));
      sighting.robust_width = options.landmark_robust_width;
      if (options.object_views) {
        sighting.landmark = id;
        sighting.covariance *= 1 - options.landmark_repeating_share;
      }
      out.sightings.push_back(sighting);
    }
    if (options.object_sizes && !view.size.empty()) out.sizes.push_back(view.size.factor(landmark.id));
    if (!options.object_views) continue;
    out.views[id] = {landmark.position, yaw, landmark.shape};
    out.shared_errors.push_back(sharedError(visits, options));
    out.shared_errors.back().view = id;
    if (landmark.has_yaw) view.offset.apply(landmark.shape, out.shared_errors.back());
  }
  if (views.empty()) return false;
  out.yaws[landmark.id] = yaw;
  if (options.object_sizes && usual) out.sizes.push_back(sizePrior(landmark.id, *usual));
  return true;
}

}  // namespace roomgraph
