// SPDX-License-Identifier: BSD-3-Clause
// Part of roomgraph, object-level semantic SLAM.
#include "roomgraph/association/landmark_map.h"

#include <algorithm>
#include <cmath>

namespace roomgraph {
namespace {

Landmark born(const WorldMeasurement& seen, LandmarkId id, double existence) {
  const auto& proposal = seen.measurement.proposal;
  Landmark landmark;
  landmark.id = id;
  landmark.class_name = proposal.class_name;
  landmark.model = proposal.model;
  landmark.shape = proposal.shape;
  landmark.position = seen.world_from_object.translation();
  landmark.yaw = planarPart(seen.world_from_object).yaw;
  landmark.has_yaw = proposal.has_yaw;
  landmark.covariance = seen.covariance;
  landmark.existence = existence;
  landmark.class_posterior[proposal.class_name] = 1;
  landmark.observations = 1;
  return landmark;
}

// Kalman update of (x, y, z, yaw) with a direct measurement of it.
void fusePlace(Landmark& landmark, const WorldMeasurement& seen) {
  const bool use_yaw = seen.measurement.proposal.has_yaw && landmark.has_yaw;
  const double yaw = planarPart(seen.world_from_object).yaw;
  Eigen::Vector4d innovation;
  innovation.head<3>() = seen.world_from_object.translation() - landmark.position;
  innovation[3] = use_yaw ? wrapAngle(yaw - landmark.yaw) : 0;
  // A measurement far off in yaw is the other reading of a symmetric shape: it says nothing about the fine
  // angle.
  const bool fine = use_yaw && std::abs(innovation[3]) < M_PI / 4;
  if (!fine) innovation[3] = 0;
  Eigen::Matrix4d noise = seen.covariance;
  if (!fine) {
    noise.row(3).setZero();
    noise.col(3).setZero();
    noise(3, 3) = 1e6;
  }
  const Eigen::Matrix4d gain = landmark.covariance * (landmark.covariance + noise).inverse();
  const Eigen::Vector4d step = gain * innovation;
  landmark.position += step.head<3>();
  landmark.yaw = wrapAngle(landmark.yaw + step[3]);
  landmark.covariance = ((Eigen::Matrix4d::Identity() - gain) * landmark.covariance).eval();
  // Measurements of one object share errors (same view, same model): a floor keeps the estimate open to new
  // views.
  for (int i = 0; i < 4; ++i) landmark.covariance(i, i) = std::max(landmark.covariance(i, i), 1e-4);
  if (!landmark.has_yaw && seen.measurement.proposal.has_yaw) {
    landmark.yaw = yaw;
    landmark.has_yaw = true;
    landmark.covariance(3, 3) = seen.covariance(3, 3);
  }
}

void fuseSize(Landmark& landmark, const ObjectShape& seen) {
  const double share = 1.0 / std::min(landmark.observations + 1, 50);
  landmark.shape.width += share * (seen.width - landmark.shape.width);
  landmark.shape.depth += share * (seen.depth - landmark.shape.depth);
  landmark.shape.height += share * (seen.height - landmark.shape.height);
}

std::vector<Eigen::Vector2d> footprintInWorld(const Landmark& landmark) {
  std::vector<Eigen::Vector2d> corners = footprint(landmark.shape);
  const Pose2 pose{landmark.position.x(), landmark.position.y(), landmark.yaw};
  for (auto& corner : corners) corner = pose * corner;
  return corners;
}

// Common ground area over the smaller footprint.
double footprintOverlap(const Landmark& a, const Landmark& b) {
  const auto base_a = footprintInWorld(a), base_b = footprintInWorld(b);
  const double smaller = std::min(polygonArea(base_a), polygonArea(base_b));
  return smaller > 0 ? polygonArea(intersectConvex(base_a, base_b)) / smaller : 0;
}

}  // namespace

void LandmarkMap::declareParameters(ParameterVisitor& v) {
  v.add("birth_existence", birth_existence_,
        {.doc = "existence probability of a landmark seen once", .min = 0.01, .max = 0.99});
  v.add("detection_probability", detection_probability_,
        {.doc = "that an existing object in good view is detected", .min = 0.01, .max = 0.99});
  v.add("score_gain", score_gain_,
        {.doc = "log of the likelihood ratio of existence per unit of a sighting's score",
         .min = 0,
         .max = 50});
  v.add("neutral_score", neutral_score_,
        {.doc = "score of a sighting that speaks neither for nor against the object", .min = 0, .max = 1});
  v.add("false_alarm_probability", false_alarm_probability_,
        {.doc = "that something is detected where there is no object", .min = 0.001, .max = 0.99});
  v.add("confirm_existence", confirm_existence_, {.doc = "existence needed for the map", .min = 0, .max = 1});
  v.add("confirm_observations", confirm_observations_,
        {.doc = "sightings needed for the map", .min = 1, .max = 1000});
  v.add("exclusive_overlap", exclusive_overlap_,
        {.doc = "share of a footprint under another landmark above which only the better seen one is kept",
         .min = 0,
         .max = 1});
  v.add("merge_overlap", merge_overlap_,
        {.doc = "3D IoU above which two landmarks of a class are one object", .min = 0.01, .max = 1});
}

const Landmark* LandmarkMap::find(LandmarkId id) const {
  for (const auto& landmark : landmarks_)
    if (landmark.id == id) return &landmark;
  return nullptr;
}

Landmark* LandmarkMap::get(LandmarkId id) {
  return const_cast<Landmark*>(find(id));
}

LandmarkId LandmarkMap::update(const WorldMeasurement& measurement, const Association& association) {
  Landmark* landmark = get(association.landmark);
  if (!landmark) {
    landmarks_.push_back(born(measurement, LandmarkId{next_id_++}, birth_existence_));
    evidence_[landmarks_.back().id] = measurement.measurement.proposal.score;
    return landmarks_.back().id;
  }
  fusePlace(*landmark, measurement);
  fuseSize(*landmark, measurement.measurement.proposal.shape);
  weigh(*landmark, std::exp(score_gain_ * (measurement.measurement.proposal.score - neutral_score_)));
  evidence_[landmark->id] += measurement.measurement.proposal.score;
  ++landmark->observations;
  return landmark->id;
}

// Bayes' rule with the likelihood ratio of "exists" against "does not".
void LandmarkMap::weigh(Landmark& landmark, double ratio) const {
  const double exists = ratio * landmark.existence;
  // Never beyond recall: an object hidden for long may be seen again, one seen for long may be gone.
  landmark.existence = std::clamp(exists / (exists + 1 - landmark.existence), 0.01, 1 - 1e-9);
}

void LandmarkMap::miss(LandmarkId id) {
  Landmark* landmark = get(id);
  if (!landmark) return;
  weigh(*landmark, (1 - detection_probability_) / (1 - false_alarm_probability_));
}

void LandmarkMap::correct(LandmarkId id, const Eigen::Vector3d& position, double yaw,
                          const Eigen::Matrix4d& covariance) {
  Landmark* landmark = get(id);
  if (!landmark) return;
  landmark->position = position;
  landmark->yaw = yaw;
  landmark->covariance = covariance;
}

std::vector<std::pair<LandmarkId, LandmarkId>> LandmarkMap::mergeDuplicates() {
  std::vector<std::pair<LandmarkId, LandmarkId>> merged;
  for (std::size_t i = 0; i < landmarks_.size(); ++i) {
    for (std::size_t j = i + 1; j < landmarks_.size();) {
      Landmark &a = landmarks_[i], &b = landmarks_[j];
      const bool same = a.class_name == b.class_name &&
                        iou3d(a.shape, a.worldFromObject(), b.shape, b.worldFromObject()) > merge_overlap_;
      if (!same) {
        ++j;
        continue;
      }
      merged.emplace_back(b.id, a.id);
      const LandmarkId kept = a.id;
      const double existence = 1 - (1 - a.existence) * (1 - b.existence);
      const int observations = a.observations + b.observations;
      if (b.observations > a.observations) a = b;
      a.id = kept;
      a.existence = existence;
      a.observations = observations;
      evidence_[kept] += evidence_[merged.back().first];
      landmarks_.erase(landmarks_.begin() + static_cast<std::ptrdiff_t>(j));
    }
  }
  return merged;
}

std::vector<Landmark> LandmarkMap::confirmed() const {
  std::vector<Landmark> sure;
  for (const auto& landmark : landmarks_)
    if (landmark.existence >= confirm_existence_ && landmark.observations >= confirm_observations_)
      sure.push_back(landmark);
  // Two things cannot be in one place: of overlapping landmarks (a sofa now and then labelled chair) the
  // better seen stays.
  std::stable_sort(sure.begin(), sure.end(), [this](const Landmark& a, const Landmark& b) {
    return evidence_.at(a.id) > evidence_.at(b.id);
  });
  std::vector<Landmark> kept;
  for (const auto& landmark : sure) {
    const bool free = std::none_of(kept.begin(), kept.end(), [&](const Landmark& other) {
      return footprintOverlap(landmark, other) > exclusive_overlap_;
    });
    if (free) kept.push_back(landmark);
  }
  std::sort(kept.begin(), kept.end(), [](const Landmark& a, const Landmark& b) { return a.id < b.id; });
  return kept;
}

}  // namespace roomgraph
