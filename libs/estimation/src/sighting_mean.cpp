// SPDX-License-Identifier: BSD-3-Clause
// Robust mean place and mean yaw of the sightings of one landmark.
#include "sighting_mean.h"

#include <cmath>
#include <limits>

#include "roomgraph/estimation/object_factors.h"

namespace roomgraph {
namespace {

constexpr int kMostSteps = 20;
constexpr double kStill_m = 1e-4;

// Squared distance in plan, in units of the robust width and the sighting's own standard deviations.
class PlaceDistance {
 public:
  PlaceDistance(const LandmarkFactor& sighting, double robust_width)
      : place_(sighting.position_in_robot.head<2>()),
        information_(robust_width > 0 ? Eigen::Matrix2d(sighting.covariance.topLeftCorner<2, 2>().inverse() /
                                                        (robust_width * robust_width))
                                      : Eigen::Matrix2d::Zero()) {}
  double operator()(const Eigen::Vector3d& place) const {
    const Eigen::Vector2d offset = place.head<2>() - place_;
    return offset.dot(information_ * offset);
  }

 private:
  Eigen::Vector2d place_;
  Eigen::Matrix2d information_;
};

// The sighting that most others agree with: where the search for the mean begins, so that a minority far off,
// a depth that was that of something in front, does not draw it away.
std::size_t medoid(const std::vector<LandmarkFactor>& sightings, const std::vector<PlaceDistance>& distances) {
  std::size_t best = 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < sightings.size(); ++i) {
    double cost = 0;
    for (std::size_t k = 0; k < sightings.size(); ++k)
      cost += weightOf(sightings[k]) * std::log1p(distances[k](sightings[i].position_in_robot));
    if (cost < least) least = cost, best = i;
  }
  return best;
}

// Shares of the sightings in the minimum of their weighted Cauchy losses, by reweighted means.
std::vector<double> robustShares(const std::vector<LandmarkFactor>& sightings, double robust_width) {
  std::vector<double> shares;
  std::vector<PlaceDistance> distances;
  for (const LandmarkFactor& sighting : sightings) {
    shares.push_back(shareOfPlace(sighting));
    distances.emplace_back(sighting, robust_width);
  }
  Eigen::Vector3d mean = sightings[medoid(sightings, distances)].position_in_robot;
  std::vector<double> robust(shares.size());
  for (int step = 0; step < kMostSteps; ++step) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    double total = 0;
    for (std::size_t i = 0; i < shares.size(); ++i) {
      robust[i] = shares[i] / (1 + distances[i](mean));
      sum += robust[i] * sightings[i].position_in_robot;
      total += robust[i];
    }
    const Eigen::Vector3d next = sum / total;
    const double moved = (next - mean).norm();
    mean = next;
    if (moved < kStill_m) break;
  }
  return robust;
}

}  // namespace

LandmarkFactor meanSighting(const std::vector<LandmarkFactor>& sightings, double robust_width) {
  LandmarkFactor mean = sightings.front();
  if (sightings.size() == 1) return mean;
  const std::vector<double> shares = robustShares(sightings, robust_width);
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Eigen::Vector2d direction = Eigen::Vector2d::Zero();
  Eigen::Matrix4d covariance = Eigen::Matrix4d::Zero();
  double sum = 0, yaw_sum = 0, yaw_weight = 0;
  for (std::size_t i = 0; i < sightings.size(); ++i) {
    const LandmarkFactor& s = sightings[i];
    position += shares[i] * s.position_in_robot;
    covariance += shares[i] * s.covariance;
    sum += shares[i];
    mean.weight = std::max(mean.weight, s.weight);
    if (!s.has_yaw) continue;
    const double yaw_share = weightOf(s) / s.covariance(3, 3);
    direction += yaw_share * Eigen::Vector2d(std::cos(s.yaw_in_robot), std::sin(s.yaw_in_robot));
    yaw_sum += yaw_share;
    yaw_weight += weightOf(s);
  }
  mean.position_in_robot = position / sum;
  mean.covariance = covariance / sum;
  mean.has_yaw = direction.norm() > 1e-9;
  if (!mean.has_yaw) return mean;
  mean.yaw_in_robot = std::atan2(direction.y(), direction.x());
  // Places may be well known where yaws are not, and the other way round.
  mean.covariance.row(3).setZero();
  mean.covariance.col(3).setZero();
  mean.covariance(3, 3) = yaw_weight / yaw_sum;
  return mean;
}

}  // namespace roomgraph
