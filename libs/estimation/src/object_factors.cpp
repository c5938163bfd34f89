// SPDX-License-Identifier: BSD-3-Clause
// Grouping of sightings by key pose, side and visit; their means and weights.
#include "roomgraph/estimation/object_factors.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "roomgraph/geometry/covariance.h"

namespace roomgraph {

LandmarkFactor sightingOf(const ObjectDecision& decision, const Landmark& landmark, const KeyPose& node,
                          const Pose3& node_from_camera) {
  const auto& measurement = decision.seen.measurement;
  const Pose3 node_from_object = node_from_camera * measurement.proposal.camera_from_object;
  LandmarkFactor factor{.node = node.id, .landmark = landmark.id};
  factor.position_in_robot = node_from_object.translation();
  factor.has_yaw = measurement.proposal.has_yaw;
  const double node_yaw = planarPart(node.world_from_robot).yaw;
  factor.yaw_in_robot = wrapAngle(planarPart(node.world_from_robot * node_from_object).yaw - node_yaw);
  if (std::abs(wrapAngle(node_yaw + factor.yaw_in_robot - landmark.yaw)) > std::numbers::pi / 2)
    factor.yaw_in_robot = wrapAngle(factor.yaw_in_robot + std::numbers::pi);
  factor.covariance = rotateCovariance(decision.seen.covariance, node.world_from_robot.linear().transpose());
  factor.weight = decision.association.probability * measurement.confidence * measurement.proposal.score;
  return factor;
}

LandmarkFactor meanSighting(const std::vector<LandmarkFactor>& sightings) {
  LandmarkFactor mean = sightings.front();
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Eigen::Vector2d direction = Eigen::Vector2d::Zero();
  Eigen::Matrix4d covariance = Eigen::Matrix4d::Zero();
  double sum = 0;
  for (const auto& s : sightings) {
    const double share = std::max(s.weight, 1e-9) / s.covariance.topLeftCorner<2, 2>().trace();
    position += share * s.position_in_robot;
    covariance += share * s.covariance;
    sum += share;
    if (s.has_yaw) direction += share * Eigen::Vector2d(std::cos(s.yaw_in_robot), std::sin(s.yaw_in_robot));
    mean.weight = std::max(mean.weight, s.weight);
  }
  mean.position_in_robot = position / sum;
  mean.covariance = covariance / sum;
  mean.has_yaw = direction.norm() > 1e-9;
  if (mean.has_yaw) mean.yaw_in_robot = std::atan2(direction.y(), direction.x());
  return mean;
}

namespace {

constexpr std::size_t kMinViews = 3;  // key poses from which a point must be seen

// A point on a landmark, seen from one key pose.
struct PointView {
  CameraPointFactor factor;
  Eigen::Vector3d in_world;
};

// Measurements of one landmark.
struct Gathered {
  std::map<NodeId, std::vector<LandmarkFactor>> sightings;
  std::map<NodeId, LandmarkBoxFactor> boxes;  // the best of each key pose
  std::map<PointId, std::map<NodeId, PointView>> points;
};

void gather(const ObjectFrame& frame, const ObjectDecision& decision, const Landmark& landmark,
            const KeyPose& node, const Pose3& node_from_camera, const BackendOptions& options, double trust,
            Gathered& out) {
  LandmarkFactor sighting = sightingOf(decision, landmark, node, node_from_camera);
  sighting.weight *= trust;
  out.sightings[node.id].push_back(sighting);
  const auto& measurement = decision.seen.measurement;
  LandmarkBoxFactor& best = out.boxes[node.id];
  if (!best.landmark.valid() || sighting.weight > best.weight)
    best = {.node = node.id,
            .landmark = landmark.id,
            .camera = frame.camera,
            .robot_from_camera = node_from_camera,
            .box = measurement.detection.box,
            .sigma_px = options.box_sigma_px,
            .weight = sighting.weight};
  for (const auto& feature : frame.features) {
    const auto& own = measurement.features;
    if (std::find(own.begin(), own.end(), feature.point) == own.end()) continue;
    const Eigen::Vector3d in_camera =
        frame.camera.backProject(feature.pixel.x(), feature.pixel.y(), feature.depth_m);
    out.points[PointId{feature.point}].try_emplace(
        node.id, PointView{{.node = node.id,
                            .point = PointId{feature.point},
                            .camera = frame.camera,
                            .robot_from_camera = node_from_camera,
                            .pixel = feature.pixel,
                            .sigma_px = options.point_sigma_px,
                            .depth_m = feature.depth_m,
                            .sigma_depth_m =
                                options.point_sigma_px * (0.005 + 0.002 * feature.depth_m * feature.depth_m)},
                           node.world_from_robot * node_from_camera * in_camera});
  }
}

LandmarkSizeFactor sizeFactor(const Landmark& landmark, const ObjectModel& model) {
  return {landmark.id,
          {model.width_m, model.depth_m, model.height_m},
          {model.width_sigma_m, model.depth_sigma_m, model.height_sigma_m}};
}

// Landmarks of the graph that stand for sides; the map's own never get that far.
constexpr std::int64_t kFirstSide = 1'000'000'000;
constexpr double kVisitPause_s = 3;    // a side not seen for so long begins a new visit
constexpr double kLeastWeight = 1e-9;  // a visit without weight would leave its side undetermined

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

using Visit = std::vector<LandmarkFactor>;  // sightings of one side in a row, placed in world

std::map<int, std::vector<Visit>> visitsBySide(const Gathered& seen, const KeyPoses& poses, double side_rad) {
  std::map<int, std::vector<Visit>> sides;
  for (const auto& [id, group] : seen.sightings) {
    const KeyPose& node = poses.node(id);
    const LandmarkFactor sighting = inWorld(meanSighting(group), node.world_from_robot);
    const Eigen::Vector3d view = sighting.position_in_robot - node.world_from_robot.translation();
    auto& visits = sides[static_cast<int>(std::floor(std::atan2(view.y(), view.x()) / side_rad))];
    // A robot that stands still makes few key poses: a visit ends only when key poses in between do not see the side.
    const bool gone = visits.empty() || (id.value - visits.back().back().node.value > 1 &&
                                         node.t - poses.node(visits.back().back().node).t > kVisitPause_s);
    if (gone) visits.emplace_back();
    visits.back().push_back(sighting);
  }
  return sides;
}

void addRevisits(const Gathered& seen, const Landmark& landmark, const KeyPoses& poses,
                 const BackendOptions& options, ObjectFactors& out) {
  for (const auto& [direction, visits] : visitsBySide(seen, poses, options.landmark_side_rad)) {
    std::vector<LandmarkFactor> sightings;
    for (const Visit& visit : visits) {
      sightings.push_back(seenFrom(meanSighting(visit), poses.node(visit[visit.size() / 2].node)));
      if (sightings.back().weight < kLeastWeight) sightings.pop_back();
    }
    if (sightings.size() < 2) continue;
    const LandmarkId side{kFirstSide + static_cast<std::int64_t>(out.sides.size())};
    out.sides[side] = {landmark.position, landmark.yaw, landmark.shape};
    for (LandmarkFactor& sighting : sightings) {
      sighting.landmark = side;
      sighting.robust_width = options.landmark_robust_width;
      out.visits.push_back(sighting);
    }
  }
}

void addPoints(const Gathered& seen, const Landmark& landmark, const BackendOptions& options,
               ObjectFactors& out) {
  int count = 0;
  for (const auto& [id, views] : seen.points) {
    if (views.size() < kMinViews || out.points.contains(id)) continue;
    if (++count > options.points_per_landmark) return;
    Eigen::Vector3d middle = Eigen::Vector3d::Zero();
    for (const auto& [node, view] : views) {
      middle += view.in_world / static_cast<double>(views.size());
      out.views.push_back(view.factor);
    }
    out.points[id] = middle;
    out.insides.push_back(
        {.point = id, .landmark = landmark.id, .weight = options.landmark_information_share});
  }
}

}  // namespace

ObjectFactors objectFactors(const std::vector<ObjectFrame>& frames, const KeyPoses& poses,
                            const std::vector<Landmark>& landmarks, const ObjectDatabase& database,
                            const BackendOptions& options, const MeasurementModel* model) {
  std::map<LandmarkId, Gathered> gathered;
  std::map<LandmarkId, const Landmark*> known;
  for (const auto& landmark : landmarks) known[landmark.id] = &landmark;
  for (const auto& frame : frames) {
    const KeyPose& node = poses.nearest(frame.t);
    const Pose3 node_from_camera = poses.offset(node, frame.t) * frame.robot_from_camera;
    for (const auto& decision : frame.decisions) {
      const auto found = known.find(decision.landmark);
      if (found == known.end()) continue;
      const Landmark& landmark = *found->second;
      if (landmark.class_name != decision.seen.measurement.proposal.class_name) continue;
      const double trust = model ? model->depthTrust(decision.seen, landmark) : 1;
      gather(frame, decision, landmark, node, node_from_camera, options, trust, gathered[landmark.id]);
    }
  }
  ObjectFactors out;
  for (const auto& [id, seen] : gathered) {
    const Landmark& landmark = *known.at(id);
    for (const auto& [node, group] : seen.sightings) {
      LandmarkFactor mean = meanSighting(group);
      mean.weight *= options.landmark_information_share;
      mean.robust_width = options.landmark_robust_width;
      out.sightings.push_back(mean);
    }
    addRevisits(seen, landmark, poses, options, out);
    const ObjectModel* usual = database.find(landmark.class_name);
    if (options.object_boxes && usual) {
      out.sizes.push_back(sizeFactor(landmark, *usual));
      for (auto [node, box] : seen.boxes) {
        box.weight *= options.landmark_information_share;
        out.boxes.push_back(box);
      }
    }
    addPoints(seen, landmark, options, out);
  }
  return out;
}

}  // namespace roomgraph
