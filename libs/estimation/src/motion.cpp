// SPDX-License-Identifier: BSD-3-Clause
// Covariance of a movement from noise model and summed steps.
#include "roomgraph/estimation/motion.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "roomgraph/geometry/covariance.h"
#include "roomgraph/observations/trajectory_velocity.h"

namespace roomgraph {
namespace {

// Standard deviation of directions that a planar source does not measure: large, but not so large that the equations
// become ill-conditioned.
constexpr double kUnmeasuredSigma = 0.5;

constexpr double kAcceleration_m_s2 = 0.5, kAcceleration_rad_s2 = 1;  // of indoor robots, one standard deviation

// How far a robot may be from where it would be without accelerating, after that time squared.
Matrix6d changeSquared(double seconds_squared) {
  Vector6d change;
  change << Eigen::Vector3d::Constant(kAcceleration_m_s2), Eigen::Vector3d::Constant(kAcceleration_rad_s2);
  change *= 0.5 * seconds_squared;
  return change.cwiseAbs2().asDiagonal();
}

Matrix6d modelCovariance(const MotionNoise& noise, const Pose3& movement, bool planar) {
  const double distance = movement.translation().norm(), angle = rotationAngle(movement);
  const double sigma_m = noise.floor_m + noise.per_m * distance;
  const double sigma_rad = noise.floor_rad + noise.per_rad * angle + noise.rad_per_m * distance;
  Vector6d sigma;
  sigma << sigma_m, sigma_m, sigma_m, sigma_rad, sigma_rad, sigma_rad;
  if (planar) sigma[2] = sigma[3] = sigma[4] = kUnmeasuredSigma;
  return sigma.cwiseAbs2().asDiagonal();
}

constexpr double kCarriedPause_s = 2, kStands_m = 0.1, kStands_rad = 0.1;  // of a source, in which the robot may be carried
constexpr double kSilent_s = 0.25;  // a longer time between two poses is not seen
constexpr double kSourceWidth = 3;  // in standard deviations: wheels slip, images mislead
constexpr std::array kOffFloor = {2, 3, 4};  // z, roll, pitch of a movement

// Of two movements: translation, and the turn that leads from one rotation to the other, both in the frame of a.
Vector6d differenceOf(const Pose3& from, const Pose3& to) {
  const Eigen::AngleAxisd turn(to.linear() * from.linear().transpose());
  Vector6d out;
  out << to.translation() - from.translation(), turn.angle() * turn.axis();
  return out;
}

Pose3 movedBy(const Pose3& movement, const Vector6d& difference) {
  Pose3 out = movement;
  out.translation() += difference.head<3>();
  const Eigen::Vector3d turn = difference.tail<3>();
  if (turn.norm() > 0) out.linear() = Eigen::AngleAxisd(turn.norm(), turn.normalized()) * movement.linear();
  return out;
}

// How far a difference is from none: squared, in kSourceWidth standard deviations.
template <int kSize>
double surpriseOf(const Eigen::Matrix<double, kSize, 1>& difference, const Eigen::Matrix<double, kSize, kSize>& covariance) {
  return difference.dot(covariance.llt().solve(difference)) / (kSourceWidth * kSourceWidth);
}

// Of the way back to the floor; it leaves x, y and yaw.
Vector6d toFloor(const Pose3& movement) { return differenceOf(movement, toPose3(planarPart(movement))); }

// Of z, roll and pitch of a movement: both its poses are on the floor, each with its own error.
Eigen::Vector3d floorVariance(const OnFloor& floor) {
  return 2 * Eigen::Vector3d(floor.sigma_z_m, floor.sigma_tilt_rad, floor.sigma_tilt_rad).cwiseAbs2();
}

Matrix6d floorInformation(const OnFloor& floor) {
  Vector6d information = Vector6d::Zero();
  information(kOffFloor) = floorVariance(floor).cwiseInverse();
  return information.asDiagonal();
}

double surpriseOffFloor(const OnFloor& floor, const Movement& movement) {
  const Eigen::Vector3d off = toFloor(movement.a_from_b)(kOffFloor);
  Eigen::Matrix3d covariance = movement.covariance(kOffFloor, kOffFloor);
  covariance.diagonal() += floorVariance(floor);
  return surpriseOf(off, covariance);
}

// The first source that stays on the floor, else the first one: what others are compared with.
const Movement& referenceOf(const std::vector<Movement>& seen, const std::optional<OnFloor>& floor) {
  const auto stays = [&](const Movement& movement) { return !floor || surpriseOffFloor(*floor, movement) < 1; };
  const auto it = std::find_if(seen.begin(), seen.end(), stays);
  return it == seen.end() ? seen.front() : *it;
}

// Wheels of a robot that is carried do not turn.
bool stands(const Pose3& moved) { return moved.translation().norm() < kStands_m && rotationAngle(moved) < kStands_rad; }

}  // namespace

Movement unknownMovement(double seconds) {
  const double sigma_m = 0.3 + 0.5 * seconds, sigma_rad = 0.3 + 0.7 * seconds;
  Vector6d sigma;
  sigma << sigma_m, sigma_m, sigma_m, sigma_rad, sigma_rad, sigma_rad;
  return {Pose3::Identity(), Matrix6d(sigma.cwiseAbs2().asDiagonal())};
}

bool MotionSource::add(double t, const Pose3& odom_from_robot, int segment) {
  const auto before = poses_.empty() ? std::nullopt : std::optional(poses_.poses().back());
  if (!append(t, odom_from_robot, segment)) return false;
  if (before && t > before->t + kCarriedPause_s && stands(before->pose.inverse() * odom_from_robot)) pauses_.emplace_back(before->t, t);
  return true;
}

bool MotionSource::append(double t, const Pose3& odom_from_robot, int segment) {
  if (!poses_.empty() && t <= poses_.lastTime()) return false;
  if (begun_.insert(segment).second) beginnings_.insert(t);
  poses_.add(t, odom_from_robot, segment);
  return true;
}

bool MotionSource::add(double t, const Pose3& odom_from_robot, int segment, const Matrix6d& step_covariance) {
  if (!append(t, odom_from_robot, segment)) return false;
  const Matrix6d before = summed_.empty() ? Matrix6d::Zero() : summed_.back().second;
  summed_.emplace_back(t, before + step_covariance);
  return true;
}

Matrix6d MotionSource::stepSum(double t_a, double t_b) const {
  const auto until = [&](double t) -> Matrix6d {
    const auto after = std::upper_bound(summed_.begin(), summed_.end(), t,
                                        [](double time, const auto& entry) { return time < entry.first; });
    return after == summed_.begin() ? Matrix6d::Zero() : std::prev(after)->second;
  };
  return until(std::max(t_a, t_b)) - until(std::min(t_a, t_b));
}

// Between two poses the movement may have changed and changed back.
Matrix6d MotionSource::interpolation(double t) const {
  const auto& poses = poses_.poses();
  const auto after = std::lower_bound(poses.begin(), poses.end(), t, [](const StampedPose& pose, double time) { return pose.t < time; });
  if (after == poses.begin() || after == poses.end()) return Matrix6d::Zero();
  const double before_t = std::prev(after)->t;
  if (after->t - before_t < kSilent_s) return Matrix6d::Zero();
  return changeSquared((t - before_t) * (after->t - t));
}

// A pose beyond the last one, b, and one before it, a, is b + r (b - a), r the share of their interval: both errors are in it, and how the movement has
// changed since.
Matrix6d MotionSource::extrapolation(double t) const {
  const auto& poses = poses_.poses();
  if (poses.empty() || t <= poses.back().t) return interpolation(t);
  const double beyond_s = t - poses.back().t;
  const auto base = velocityBase(poses_, true);
  if (!base) return unknownMovement(beyond_s).covariance;
  const double r = beyond_s / (poses.back().t - poses[*base].t);
  return 2 * r * (1 + r) * stepAt(poses.back().t) + changeSquared(beyond_s * beyond_s);
}

std::optional<Movement> MotionSource::between(double t_a, double t_b, double horizon_s) const {
  if (poses_.empty()) return std::nullopt;
  const auto movement = poses_.between(t_a, t_b, horizon_s);
  if (!movement) return std::nullopt;
  return Movement{*movement, modelCovariance(noise_, *movement, planar_) + stepSum(t_a, t_b) + pausesWithin(t_a, t_b) +
                                 interpolation(std::min(t_a, t_b)) + extrapolation(std::max(t_a, t_b))};
}

Matrix6d MotionSource::pausesWithin(double t_a, double t_b) const {
  Matrix6d out = Matrix6d::Zero();
  for (const auto& [from, until] : pauses_) {
    const double seconds = std::min(until, std::max(t_a, t_b)) - std::max(from, std::min(t_a, t_b));
    if (seconds > 0) out += unknownMovement(seconds).covariance;
  }
  return out;
}

bool MotionSource::pausedWithin(double t_a, double t_b) const {
  const auto [early, late] = std::minmax(t_a, t_b);
  return std::any_of(pauses_.begin(), pauses_.end(), [&](const auto& pause) { return pause.first < late && pause.second > early; });
}

// Of the step that ends at t or as the first one after it. No step leads to the pose that begins a segment: it is
// where its frame begins, and known in it without error.
Matrix6d MotionSource::stepAt(double t) const {
  if (summed_.empty()) return Matrix6d::Zero();
  auto step = std::lower_bound(summed_.begin(), summed_.end(), t,
                               [](const auto& entry, double time) { return entry.first < time; });
  if (step == summed_.end()) --step;
  if (beginnings_.contains(step->first)) return Matrix6d::Zero();
  return step == summed_.begin() ? step->second : Matrix6d(step->second - std::prev(step)->second);
}

// A match is told in the frame of the robot, the movement in that of its beginning.
std::optional<Movement> MotionSource::inLocalMap(double t_a, double t_b, double horizon_s) const {
  if (poses_.empty()) return std::nullopt;
  const auto movement = poses_.between(t_a, t_b, horizon_s);
  if (!movement) return std::nullopt;
  return Movement{*movement,
                  modelCovariance(noise_, Pose3::Identity(), planar_) +
                      rotateCovariance(Matrix6d(stepAt(t_b) + extrapolation(t_b)), movement->linear())};
}

Matrix6d MotionSource::addsUp(const Matrix6d& covariance) const {
  Vector6d share;
  share << Eigen::Vector3d::Constant(std::sqrt(noise_.drift_share)),
      Eigen::Vector3d::Constant(std::sqrt(noise_.drift_share_rotation));
  return share.asDiagonal() * covariance * share.asDiagonal();
}

// Both ends of the movement are poses of the source itself: what the matches there err by is in the key poses that
// are seen from them, not in how one map lies to the next.
std::optional<Movement> MotionSource::betweenLocalMaps(double t_a, double t_b, double horizon_s) const {
  if (poses_.empty()) return std::nullopt;
  const auto movement = poses_.between(t_a, t_b, horizon_s);
  if (!movement) return std::nullopt;
  Matrix6d drift = addsUp(modelCovariance(noise_, *movement, false) + stepSum(t_a, t_b));
  if (planar_)
    for (const int unmeasured : {2, 3, 4}) drift(unmeasured, unmeasured) += kUnmeasuredSigma * kUnmeasuredSigma;
  return Movement{*movement, drift};
}

// Weighted mean of the movements' differences from one of them. A source that contradicts that one weighs less (Cauchy); one that leaves
// the floor weighs next to nothing (Geman and McClure): images are sure of what they show even where they mislead.
std::optional<Pose3> Motion::movement(double t_a, double t_b, double horizon_s) const {
  std::vector<Movement> all;
  for (const auto* source : {&lidar, &visual, &odometry})
    if (const auto seen = source->between(t_a, t_b, horizon_s)) all.push_back(*seen);
  if (all.empty()) return std::nullopt;
  const Movement& reference = referenceOf(all, floor);
  // Rotations are told from the floor, where there is one: tilts of a misled source would not add up with the yaws of another.
  const Pose3 origin = floor ? toPose3(planarPart(reference.a_from_b)) : reference.a_from_b;
  Matrix6d information = floor ? floorInformation(*floor) : Matrix6d::Zero();
  Vector6d sum = Vector6d::Zero();
  for (const Movement& seen : all) {
    const Vector6d difference = differenceOf(reference.a_from_b, seen.a_from_b);
    const Matrix6d both = reference.covariance + seen.covariance;
    Matrix6d weight = seen.covariance.inverse() / (1 + surpriseOf(difference, both));
    if (floor) weight /= std::pow(1 + surpriseOffFloor(*floor, seen), 2);
    information += weight;
    sum += weight * differenceOf(origin, seen.a_from_b);
  }
  return movedBy(origin, information.llt().solve(sum));
}

}  // namespace roomgraph
