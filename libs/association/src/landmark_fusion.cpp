// SPDX-License-Identifier: BSD-3-Clause
// Kalman update in Joseph form, yaw and label votes, size mean, and two-means split of sightings.
#include "roomgraph/association/landmark_fusion.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "roomgraph/association/landmark_rules.h"

namespace roomgraph {
namespace {

constexpr double kOutlier = 16;         // squared Mahalanobis distance
constexpr double kMostInflation = 1e4;  // largest factor on the covariance of an outlier
constexpr double kLabelPrior = 0.5;     // pseudo-votes per class
constexpr double kMaxSizeWeight = 50;   // sizes may follow an object seen better later
constexpr std::size_t kMaxRecent = 40;
constexpr std::size_t kLeastOnOneSide = 3;
constexpr double kLeastShare = 0.25, kMaxSpread = 0.25;  // of the weight; of the distance

// One step of two-means from given centres; a group without weight keeps its centre.
void assignModes(const std::vector<PlaceSketch>& sightings, Split& split) {
  Eigen::Vector2d sums[2] = {Eigen::Vector2d::Zero(), Eigen::Vector2d::Zero()};
  double weights[2] = {0, 0};
  for (std::size_t i = 0; i < sightings.size(); ++i) {
    const auto& s = sightings[i];
    const bool second = (s.place - split.second).norm() < (s.place - split.first).norm();
    split.is_second[i] = second;
    sums[second] += s.weight * s.place;
    weights[second] += s.weight;
  }
  if (weights[0] > 0) split.first = sums[0] / weights[0];
  if (weights[1] > 0) split.second = sums[1] / weights[1];
  split.second_share = weights[1] / (weights[0] + weights[1]);
}

double meanDistance(const std::vector<PlaceSketch>& sightings, const Split& split) {
  double sum = 0, weight = 0;
  for (std::size_t i = 0; i < sightings.size(); ++i) {
    sum +=
        sightings[i].weight * (sightings[i].place - (split.is_second[i] ? split.second : split.first)).norm();
    weight += sightings[i].weight;
  }
  return sum / weight;
}

// Starts from the pair of sightings that are farthest apart.
Split twoMeans(const std::vector<PlaceSketch>& sightings) {
  Split split;
  split.is_second.assign(sightings.size(), 0);
  double farthest = -1;
  for (const auto& a : sightings)
    for (const auto& b : sightings)
      if ((a.place - b.place).norm() > farthest) {
        farthest = (a.place - b.place).norm();
        split.first = a.place;
        split.second = b.place;
      }
  for (int iteration = 0; iteration < 10; ++iteration) assignModes(sightings, split);
  return split;
}

}  // namespace

bool isElsewhere(const Landmark& landmark, const WorldMeasurement& seen) {
  const Eigen::Vector2d gap = (seen.world_from_object.translation() - landmark.position).head<2>();
  const Eigen::Matrix2d joint = (landmark.covariance + seen.covariance).topLeftCorner<2, 2>();
  return gap.dot(joint.inverse() * gap) > kOutlier;
}

void fusePlace(Landmark& landmark, const WorldMeasurement& seen) {
  const bool use_yaw = seen.measurement.proposal.has_yaw && landmark.has_yaw;
  const double yaw = planarPart(seen.world_from_object).yaw;
  Eigen::Vector4d innovation;
  innovation.head<3>() = seen.world_from_object.translation() - landmark.position;
  innovation[3] = use_yaw ? wrapAngle(yaw - landmark.yaw) : 0;
  // A measurement far off in yaw is the other symmetric solution: it does not measure the angle.
  const bool fine = use_yaw && std::abs(innovation[3]) < M_PI / 4;
  if (!fine) innovation[3] = 0;
  Eigen::Matrix4d noise = seen.covariance;
  if (seen.measurement.detection.carried) noise /= kCarriedShare;
  // An outlier was assigned by its track or features.
  const Eigen::Matrix2d joint = (landmark.covariance + noise).topLeftCorner<2, 2>();
  const double squared = innovation.head<2>().dot(joint.inverse() * innovation.head<2>());
  if (squared > kOutlier) noise *= std::min(std::pow(squared / kOutlier, 2), kMostInflation);
  if (!fine) {
    noise.row(3).setZero();
    noise.col(3).setZero();
    noise(3, 3) = 1e6;
  }
  const Eigen::Matrix4d gain = landmark.covariance * (landmark.covariance + noise).inverse();
  const Eigen::Vector4d step = gain * innovation;
  landmark.position += step.head<3>();
  landmark.yaw = wrapAngle(landmark.yaw + step[3]);
  // Joseph's form: stays symmetric and positive whatever the rounding.
  const Eigen::Matrix4d rest = Eigen::Matrix4d::Identity() - gain;
  const Eigen::Matrix4d fused =
      rest * landmark.covariance * rest.transpose() + gain * noise * gain.transpose();
  landmark.covariance = (fused + fused.transpose()) / 2;
  for (int i = 0; i < 4; ++i) landmark.covariance(i, i) = std::max(landmark.covariance(i, i), kLeastVariance);
  if (!landmark.has_yaw && seen.measurement.proposal.has_yaw) {
    landmark.yaw = yaw;
    landmark.has_yaw = true;
    landmark.covariance(3, 3) = seen.covariance(3, 3);
  }
}

void voteYaw(Landmark& landmark, LandmarkRecord& record, const WorldMeasurement& seen) {
  if (!seen.measurement.proposal.has_yaw || !landmark.has_yaw) return;
  const double apart = std::abs(wrapAngle(planarPart(seen.world_from_object).yaw - landmark.yaw));
  const double weight = sightingWeight(seen.measurement);
  if (apart < M_PI / 4) record.front += weight;
  if (apart > 3 * M_PI / 4) record.back += weight;
  if (record.back <= record.front) return;
  landmark.yaw = wrapAngle(landmark.yaw + M_PI);
  std::swap(record.front, record.back);
}

void fuseSize(Landmark& landmark, LandmarkRecord& record, const ObjectMeasurement& seen) {
  const double weight = sightingWeight(seen) * visibleFraction(seen);
  record.size_weight = std::min(record.size_weight + weight, kMaxSizeWeight);
  if (record.size_weight <= 0) return;
  const double share = weight / record.size_weight;
  const auto& shape = seen.proposal.shape;
  landmark.shape.width += share * (shape.width - landmark.shape.width);
  landmark.shape.depth += share * (shape.depth - landmark.shape.depth);
  landmark.shape.height += share * (shape.height - landmark.shape.height);
}

void voteLabel(Landmark& landmark, LandmarkRecord& record, const ObjectMeasurement& seen) {
  record.labels[seen.proposal.class_name] += sightingWeight(seen);
  double total = 0;
  for (const auto& [label, votes] : record.labels) total += votes + kLabelPrior;
  landmark.class_posterior.clear();
  for (const auto& [label, votes] : record.labels)
    landmark.class_posterior[label] = (votes + kLabelPrior) / total;
}

void remember(LandmarkRecord& record, const WorldMeasurement& seen) {
  const double variance = std::max(seen.covariance(0, 0), seen.covariance(1, 1));
  record.recent.push_back({seen.world_from_object.translation().head<2>(), std::sqrt(variance),
                           sightingWeight(seen.measurement)});
  if (record.recent.size() > kMaxRecent) record.recent.pop_front();
}

namespace {

// One object casts one shadow: rays after a frame are taken from the first record that has some there.
void joinUpdates(LandmarkRecord& record, const LandmarkRecord& other) {
  std::set<FrameId> known;
  for (const auto& update : record.existence_updates)
    if (!update.missed_in.valid()) known.insert(update.after);
  auto& all = record.existence_updates;
  for (const auto& update : other.existence_updates)
    if (update.missed_in.valid() || !known.contains(update.after)) all.push_back(update);
  std::stable_sort(all.begin(), all.end(), [](const ExistenceUpdate& a, const ExistenceUpdate& b) { return a.after < b.after; });
  record.ray_support = 0;
  std::erase_if(all, [&](ExistenceUpdate& update) {
    if (update.missed_in.valid() || update.log_ratio < 0) return false;
    update.log_ratio = std::min(update.log_ratio, kMaxRaySupport - record.ray_support);
    record.ray_support += update.log_ratio;
    return update.log_ratio <= 0;
  });
}

}  // namespace

void joinRecords(LandmarkRecord& record, const LandmarkRecord& other, bool turned) {
  record.evidence += other.evidence;
  joinUpdates(record, other);
  record.front += turned ? other.back : other.front;
  record.back += turned ? other.front : other.back;
  for (const auto& [label, votes] : other.labels) record.labels[label] += votes;
  record.size_weight = std::min(record.size_weight + other.size_weight, kMaxSizeWeight);
  record.recent.insert(record.recent.begin(), other.recent.begin(), other.recent.end());
  while (record.recent.size() > kMaxRecent) record.recent.pop_front();
}

std::optional<Split> findSplit(const std::vector<PlaceSketch>& sightings, double least_distance_m) {
  std::vector<PlaceSketch> precise;
  for (const auto& s : sightings)
    if (s.sigma_m < least_distance_m / 2 && s.weight > 0) precise.push_back(s);
  if (precise.size() < 2 * kLeastOnOneSide) return std::nullopt;
  const Split modes = twoMeans(precise);
  const double distance = (modes.first - modes.second).norm();
  const auto count = static_cast<std::size_t>(std::count(modes.is_second.begin(), modes.is_second.end(), 1));
  if (distance < least_distance_m || meanDistance(precise, modes) > kMaxSpread * distance)
    return std::nullopt;
  if (std::min(count, precise.size() - count) < kLeastOnOneSide) return std::nullopt;
  if (std::min(modes.second_share, 1 - modes.second_share) < kLeastShare) return std::nullopt;
  Split out = modes;
  if (out.second_share > 0.5) {
    std::swap(out.first, out.second);
    out.second_share = 1 - out.second_share;
  }
  out.is_second.assign(sightings.size(), 0);
  for (std::size_t i = 0; i < sightings.size(); ++i)
    out.is_second[i] = (sightings[i].place - out.second).norm() < (sightings[i].place - out.first).norm();
  return out;
}

}  // namespace roomgraph
