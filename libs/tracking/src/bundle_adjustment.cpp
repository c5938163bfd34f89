// SPDX-License-Identifier: BSD-3-Clause
// Local bundle adjustment: choice of the window, what takes part, outlier removal.
#include "bundle_adjustment.h"

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <tuple>

#include "roomgraph/core/errors.h"
#include "roomgraph/core/result_store.h"
#include "sparse_bundle.h"

namespace roomgraph::tracking {
namespace {

constexpr double kAdjustmentChi2 = 5.991;   // 95 %, 2 degrees of freedom
constexpr double kMaxDepthSigmas = 3;  // a depth further off is not used
constexpr double kAdjustmentHuber = 2.0;         // sigma
constexpr double kTolerance = 1e-4;              // relative change of the cost
constexpr int kMinShared = 10;         // points that make two keyframes neighbours

/// camera_from_odom as rotation vector and translation.
using PoseBlock = std::array<double, 6>;

PoseBlock toBlock(const Pose3& pose) {
  const Eigen::Vector3d r = logSO3(pose.linear()), t = pose.translation();
  return {r.x(), r.y(), r.z(), t.x(), t.y(), t.z()};
}

Pose3 fromBlock(const PoseBlock& block) {
  Pose3 pose = Pose3::Identity();
  pose.linear() = expSO3({block[0], block[1], block[2]});
  pose.translation() << block[3], block[4], block[5];
  return normalized(pose.inverse());
}

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

/// One local problem around a keyframe.
class LocalProblem {
 public:
  LocalProblem(LocalMap& map, std::map<int, bool> window, const TrackingParameters& parameters)
      : map_(map), window_(std::move(window)), parameters_(parameters) {
    std::vector<int> moving;
    for (const auto& [index, moves] : window_)
      if (moves) moving.push_back(index);
    ids_ = map_.pointsOf(moving);
  }

  /// The solution as numbers: camera_from_odom of the keyframes that move, then each point that takes part
  /// with its id; nothing when there is none.
  std::vector<double> solve() const {
    SparseBundle bundle;
    std::map<int, int> cameras;  // of keyframes
    for (const auto& [index, moves] : window_) {
      const Keyframe& keyframe = map_.keyframe(index);
      cameras[index] = static_cast<int>(bundle.cameras.size());
      bundle.cameras.push_back({keyframe.camera, keyframe.odom_from_camera.inverse(), moves});
    }
    std::vector<std::int64_t> taking_part;
    for (const auto id : ids_) {
      BundlePoint point = bundlePoint(id, cameras);
      if (point.terms.empty()) continue;
      taking_part.push_back(id);
      bundle.points.push_back(std::move(point));
    }
    if (bundle.points.empty() || !adjust(bundle, {parameters_.ba_iterations, kAdjustmentHuber, kTolerance})) return {};
    std::vector<double> solution;
    for (const BundleCamera& camera : bundle.cameras)
      if (camera.moves) {
        const PoseBlock block = toBlock(camera.camera_from_odom);
        solution.insert(solution.end(), block.begin(), block.end());
      }
    for (std::size_t i = 0; i < taking_part.size(); ++i) {
      const Eigen::Vector3d& place = bundle.points[i].position;
      solution.insert(solution.end(), {static_cast<double>(taking_part[i]), place.x(), place.y(), place.z()});
    }
    return solution;
  }

  /// Takes over what solve() gave.
  void write(const std::vector<double>& solution) {
    if (solution.empty()) return;
    requireFitting(solution);
    auto next = solution.begin();
    std::map<int, Pose3> refined;
    for (const auto& [index, moves] : window_) {
      if (!moves) continue;
      PoseBlock block;
      for (double& number : block) number = *next++;
      refined[index] = fromBlock(block);
    }
    std::set<std::int64_t> adjusted;
    while (next != solution.end()) {
      const auto id = static_cast<std::int64_t>(*next++);
      adjusted.insert(id);
      for (double& value : map_.point(id).position) value = *next++;
    }
    moveAlong(refined, adjusted);
    removeOutliers();
  }

 private:
  /// Throws InputError unless the numbers are those of solve(); a checkpoint may have been changed.
  void requireFitting(const std::vector<double>& solution) const {
    constexpr std::size_t kPointNumbers = 4;
    const auto moving = std::count_if(window_.begin(), window_.end(), [](const auto& entry) { return entry.second; });
    const std::size_t poses = static_cast<std::size_t>(moving) * std::tuple_size_v<PoseBlock>;
    bool fits = solution.size() >= poses && (solution.size() - poses) % kPointNumbers == 0;
    for (std::size_t i = poses; fits && i < solution.size(); i += kPointNumbers)
      fits = solution[i] >= 0 && solution[i] < static_cast<double>(map_.points.size());
    if (!fits) throw InputError("checkpoint: a local adjustment in it belongs to another map");
  }

  /// A point with the keyframes of the window that see it; without terms when these are fewer than two.
  BundlePoint bundlePoint(std::int64_t id, const std::map<int, int>& cameras) const {
    const MapPoint& seen = map_.point(id);
    BundlePoint point{seen.position, {}};
    const auto inside = std::count_if(seen.sightings.begin(), seen.sightings.end(),
                                      [&](const Sighting& s) { return window_.contains(s.keyframe); });
    if (inside < 2) return point;
    for (const auto& s : seen.sightings) {
      const auto camera = cameras.find(s.keyframe);
      if (camera == cameras.end()) continue;
      const Keyframe& keyframe = map_.keyframe(s.keyframe);
      Observation observation = keyframe.observation(s.feature, parameters_);
      const Eigen::Vector3d residual = whitened(keyframe, observation, seen.position);
      if (std::abs(residual.z()) > 1e8) continue;  // behind the camera
      if (std::abs(residual.z()) > kMaxDepthSigmas) observation.depth = 0;
      point.terms.push_back({camera->second, observation});
    }
    return point;
  }

  // A point that was not optimised moves rigidly with the keyframe that created it.
  void moveAlong(const std::map<int, Pose3>& refined, const std::set<std::int64_t>& adjusted) {
    for (const auto& [index, odom_from_camera] : refined) {
      Keyframe& keyframe = map_.keyframe(index);
      const Pose3 shift = odom_from_camera * keyframe.odom_from_camera.inverse();
      for (const auto id : keyframe.points)
        if (id >= 0 && !adjusted.contains(id) && map_.point(id).sightings.front().keyframe == index)
          map_.point(id).position = shift * map_.point(id).position;
      keyframe.odom_from_camera = odom_from_camera;
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
  std::vector<std::int64_t> ids_;
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
