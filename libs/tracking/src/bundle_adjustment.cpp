// SPDX-License-Identifier: BSD-3-Clause
// Local bundle adjustment with Ceres: choice of the window, Huber loss, outlier removal.
#include "bundle_adjustment.h"

#include <ceres/ceres.h>
#include <ceres/rotation.h>

#include <algorithm>
#include <array>
#include <map>
#include <set>

#include "roomgraph/core/result_store.h"

namespace roomgraph::tracking {
namespace {

constexpr double kAdjustmentChi2 = 5.991;   // 95 %, 2 degrees of freedom
constexpr double kMaxDepthSigmas = 3;  // a depth further off is not used
constexpr double kAdjustmentHuber = 2.0;         // sigma
constexpr int kMinShared = 10;         // points that make two keyframes neighbours

/// camera_from_odom as rotation vector and translation.
using PoseBlock = std::array<double, 6>;

PoseBlock toBlock(const Pose3& odom_from_camera) {
  const Pose3 pose = odom_from_camera.inverse();
  const Eigen::Vector3d r = logSO3(pose.linear()), t = pose.translation();
  return {r.x(), r.y(), r.z(), t.x(), t.y(), t.z()};
}

Pose3 fromBlock(const PoseBlock& block) {
  Pose3 pose = Pose3::Identity();
  pose.linear() = expSO3({block[0], block[1], block[2]});
  pose.translation() << block[3], block[4], block[5];
  return normalized(pose.inverse());
}

struct ReprojectionCost {
  PinholeCamera camera;
  Observation observation;
  template <class T>
  bool operator()(const T* pose, const T* point, T* residual) const {
    T p[3];
    ceres::AngleAxisRotatePoint(pose, point, p);
    for (int i = 0; i < 3; ++i) p[i] += pose[3 + i];
    if (p[2] < T(0.05)) return false;
    reprojectionResidual(camera, observation, p, residual);
    return true;
  }
};

/// Which keyframes take part: true when the keyframe may move.
std::map<int, bool> chooseWindow(const LocalMap& map, int index, const TrackingParameters& parameters) {
  std::map<int, bool> window{{index, true}};
  for (const auto& [shared, other] : map.covisible(map.keyframe(index).points))
    if (shared >= kMinShared && static_cast<int>(window.size()) < parameters.ba_window) window[other] = true;
  std::vector<int> moving;
  for (const auto& entry : window) moving.push_back(entry.first);
  int fixed = 0;
  for (const auto& [shared, other] : map.covisible(map.pointsOf(moving)))
    if (fixed < parameters.ba_fixed_keyframes && shared >= kMinShared && window.emplace(other, false).second)
      ++fixed;
  if (fixed == 0) window.begin()->second = false;
  return window;
}

Eigen::Vector3d whitened(const Keyframe& keyframe, const Observation& observation,
                         const Eigen::Vector3d& position) {
  const Eigen::Vector3d p = keyframe.odom_from_camera.inverse() * position;
  Eigen::Vector3d r = Eigen::Vector3d::Constant(1e9);
  if (p.z() > 0.05) reprojectionResidual(keyframe.camera, observation, p.data(), r.data());
  return r;
}

/// One local problem; owns the parameter blocks while Ceres works on them.
class LocalProblem {
 public:
  LocalProblem(LocalMap& map, std::map<int, bool> window, const TrackingParameters& parameters)
      : map_(map), window_(std::move(window)), parameters_(parameters) {
    for (const auto& [index, moves] : window_) poses_[index] = toBlock(map_.keyframe(index).odom_from_camera);
    std::vector<int> moving;
    for (const auto& [index, moves] : window_)
      if (moves) moving.push_back(index);
    ids_ = map_.pointsOf(moving);
  }

  /// The solution as numbers: camera_from_odom of the keyframes that move, then each point that takes part
  /// with its id; nothing when there is none.
  std::vector<double> solve() {
    ceres::Problem::Options options;
    options.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
    ceres::Problem problem(options);
    for (const auto id : ids_) addPoint(problem, id);
    if (problem.NumResidualBlocks() == 0) return {};
    for (const auto& [index, moves] : window_)
      if (!moves && problem.HasParameterBlock(poses_[index].data()))
        problem.SetParameterBlockConstant(poses_[index].data());
    ceres::Solver::Options solver;
    solver.linear_solver_type = ceres::DENSE_SCHUR;
    solver.max_num_iterations = parameters_.ba_iterations;
    solver.num_threads = 1;
    solver.logging_type = ceres::SILENT;
    solver.function_tolerance = 1e-4;
    ceres::Solver::Summary summary;
    ceres::Solve(solver, &problem, &summary);
    if (!summary.IsSolutionUsable()) return {};
    std::vector<double> solution;
    for (const auto& [index, moves] : window_)
      if (moves) solution.insert(solution.end(), poses_[index].begin(), poses_[index].end());
    for (const auto id : ids_) {
      const Eigen::Vector3d& place = map_.point(id).position;
      if (problem.HasParameterBlock(place.data()))
        solution.insert(solution.end(), {static_cast<double>(id), place.x(), place.y(), place.z()});
    }
    return solution;
  }

  /// Takes over what solve() gave.
  void write(const std::vector<double>& solution) {
    if (solution.empty()) return;
    auto next = solution.begin();
    for (const auto& [index, moves] : window_)
      for (std::size_t k = 0; moves && k < poses_[index].size(); ++k) poses_[index][k] = *next++;
    std::set<std::int64_t> adjusted;
    while (next != solution.end()) {
      const auto id = static_cast<std::int64_t>(*next++);
      adjusted.insert(id);
      for (double& value : map_.point(id).position) value = *next++;
    }
    moveAlong(adjusted);
    removeOutliers();
  }

 private:
  void addPoint(ceres::Problem& problem, std::int64_t id) {
    auto& point = map_.point(id);
    int sightings = 0;
    for (const auto& s : point.sightings) sightings += window_.contains(s.keyframe);
    if (sightings < 2) return;
    for (const auto& s : point.sightings) {
      if (!window_.contains(s.keyframe)) continue;
      const Keyframe& keyframe = map_.keyframe(s.keyframe);
      Observation observation = keyframe.observation(s.feature, parameters_);
      const Eigen::Vector3d residual = whitened(keyframe, observation, point.position);
      if (std::abs(residual.z()) > 1e8) continue;
      if (std::abs(residual.z()) > kMaxDepthSigmas) observation.depth = 0;
      problem.AddResidualBlock(new ceres::AutoDiffCostFunction<ReprojectionCost, 3, 6, 3>(
                                   new ReprojectionCost{keyframe.camera, observation}),
                               &loss_, poses_[s.keyframe].data(), point.position.data());
    }
  }

  // A point that was not optimised moves rigidly with the keyframe that created it.
  void moveAlong(const std::set<std::int64_t>& adjusted) {
    for (const auto& [index, moves] : window_) {
      if (!moves) continue;
      Keyframe& keyframe = map_.keyframe(index);
      const Pose3 refined = fromBlock(poses_[index]);
      const Pose3 shift = refined * keyframe.odom_from_camera.inverse();
      for (const auto id : keyframe.points)
        if (id >= 0 && !adjusted.contains(id) && map_.point(id).sightings.front().keyframe == index)
          map_.point(id).position = shift * map_.point(id).position;
      keyframe.odom_from_camera = refined;
    }
  }

  void removeOutliers() {
    for (const auto id : ids_) {
      const auto sightings = map_.point(id).sightings;
      if (sightings.size() < 2) continue;
      for (const auto& s : sightings) {
        if (!window_.contains(s.keyframe)) continue;
        const Keyframe& keyframe = map_.keyframe(s.keyframe);
        const Eigen::Vector3d r =
            whitened(keyframe, keyframe.observation(s.feature, parameters_), map_.point(id).position);
        if (r.head<2>().squaredNorm() > kAdjustmentChi2) map_.removeSighting(id, s.keyframe);
      }
    }
  }

  LocalMap& map_;
  std::map<int, bool> window_;
  const TrackingParameters& parameters_;
  std::map<int, PoseBlock> poses_;
  std::vector<std::int64_t> ids_;
  ceres::HuberLoss loss_{kAdjustmentHuber};
};

}  // namespace

void adjustLocally(LocalMap& map, int index, const TrackingParameters& parameters, ResultStore* results) {
  if (parameters.ba_iterations == 0) return;
  auto window = chooseWindow(map, index, parameters);
  if (window.size() < 2) return;
  LocalProblem problem(map, std::move(window), parameters);
  problem.write(recalled(
      results, "local adjustment", map.keyframe(index).t, [&] { return problem.solve(); }, bytesOfNumbers,
      numbersFrom));
}

}  // namespace roomgraph::tracking
