// SPDX-License-Identifier: BSD-3-Clause
// The map and the trajectories at the end of a run.
#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <string>

#include "continued_map.h"
#include "roomgraph/core/errors.h"
#include "roomgraph/core/heap.h"
#include "roomgraph/pipeline/semantic_slam.h"
#include "stage_borders.h"

namespace roomgraph {
namespace {

std::vector<Landmark> inMap(const std::vector<Candidate>& candidates, const LandmarkMap& map,
                            const ExistenceOptions& options) {
  std::vector<Landmark> sure;
  for (const auto& [landmark, evidence] : candidates)
    if (options.enabled ? options.isSure(landmark) : map.isConfirmed(landmark)) sure.push_back(landmark);
  return map.exclusive(std::move(sure));
}

// The covariances of the graph are those of the shapes' middles; where the objects' own are, no number of views tells.
void setCovariances(std::vector<Candidate>& candidates, const FactorGraph& graph, const ObjectDatabase& database,
                    std::map<std::string, int>& reasons) {
  std::vector<LandmarkId> ids;  // without the graph's own, the views
  for (const auto& [landmark, evidence] : candidates) ids.push_back(landmark.id);
  const auto covariances = graph.landmarkCovariances(ids);
  if (!covariances) return;
  for (auto& [landmark, evidence] : candidates) {
    const auto found = covariances->find(landmark.id);
    if (found == covariances->end() || isBroken("back end", problemOfCovariance(found->second), reasons)) continue;
    landmark.covariance = found->second;
    const ObjectModel* model = database.find(landmark.class_name);
    if (model) landmark.covariance.diagonal().head<2>().array() += std::pow(model->place_sigma_m, 2);
  }
}

}  // namespace

SlamResult SemanticSlam::collect() {
  giveBackFreedMemory();  // covariances need as much as an optimisation of all
  const KeyPoses& poses = estimator_.poses();
  SlamResult result;
  result.counts = counts_;
  result.counts.key_poses = static_cast<int>(poses.nodes().size());
  const auto& closures = estimator_.closures();
  const auto links = std::count_if(closures.begin(), closures.end(), [](const auto& closure) { return closure.link; });
  result.counts.links = static_cast<int>(links);
  result.counts.loop_closures = static_cast<int>(closures.size()) - result.counts.links;
  if (const int refused = estimator_.refusedClosures(); refused > 0)
    result.counts.reasons["loop closing: images against the movement since"] = refused;
  result.map.planar = estimator_.planar();
  if (poses.empty()) return result;
  const ExistenceOptions& existence = setup_->options.existence;
  result.candidates = objects_.candidates(setup_->database, existence.enabled ? &existence_ : nullptr);
  setCovariances(result.candidates, graph(), setup_->database, result.counts.reasons);
  result.map.landmarks = inMap(result.candidates, objects_.landmarks(), existence);
  result.seen = objects_.seenSpans();
  for (const Landmark& landmark : result.map.landmarks)
    result.map.weights[landmark.id] = objects_.landmarks().weightOf(landmark.id);
  if (map_) result.earlier = earlierMapOf(*map_, first_t_.value_or(0));
  if (map_ && map_->anchoring()) continueMap(*map_, {objects_, setup_->database, setup_->options}, result);
  Trajectory dense;
  for (const double t : timesOfPoses())
    if (dense.empty() || t > dense.lastTime()) dense.add(t, poses.at(t));
  result.map.world_from_robot.assign(dense.poses().begin(), dense.poses().end());
  result.world_from_robot = result.map.world_from_robot;
  for (const auto& [t, mount] : camera_mounts_) result.world_from_camera.push_back({t, poses.at(t) * mount});
  mapOccupancy(result, dense);
  return result;
}

// Those of frames and scans; of wheels, ten a second, where neither came for a second.
std::vector<double> SemanticSlam::timesOfPoses() const {
  constexpr double kEvery_s = 0.1;
  if (robot_times_.empty()) return odometry_times_;
  std::vector<double> alone;
  auto next = robot_times_.begin();
  for (const double t : odometry_times_) {
    while (next != robot_times_.end() && *next <= t) ++next;
    const bool far_after = next == robot_times_.begin() || t > *std::prev(next) + kOdometryAlone_s;
    const bool far_before = next == robot_times_.end() || *next > t + kOdometryAlone_s;
    if (far_after && far_before && (alone.empty() || t >= alone.back() + kEvery_s)) alone.push_back(t);
  }
  std::vector<double> out;
  std::merge(robot_times_.begin(), robot_times_.end(), alone.begin(), alone.end(), std::back_inserter(out));
  return out;
}

// The grid and the views, of an earlier map, too.
void SemanticSlam::mapOccupancy(SlamResult& result, const Trajectory& dense) {
  const auto timing = times_.measure("occupancy map");
  const CSemanticMap* earlier = map_ && map_->anchoring() ? &map_->map() : nullptr;
  result.map.views = views_.views(estimator_.poses(), earlier ? earlier->views : std::vector<KeyView>());
  try {
    result.map.occupancy = mapper_.build(dense, earlier ? earlier->occupancy.get() : nullptr);
  } catch (const RunError& error) {  // all else is still good
    ++result.counts.reasons[error.what()];
  }
}

}  // namespace roomgraph
