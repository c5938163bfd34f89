// SPDX-License-Identifier: BSD-3-Clause
// Gathering of what was measured of each landmark; boxes and points.
#include "roomgraph/estimation/object_factors.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "landmark_views.h"
#include "measurement_in_world.h"
#include "object_weights.h"
#include "roomgraph/association/landmark_rules.h"
#include "roomgraph/geometry/covariance.h"
#include "roomgraph/geometry/projection.h"

namespace roomgraph {

LandmarkFactor sightingOf(const ObjectDecision& decision, LandmarkId landmark, const KeyPose& node,
                          const Pose3& node_from_camera) {
  const auto& measurement = decision.seen.measurement;
  const Pose3 node_from_object = node_from_camera * measurement.proposal.camera_from_object;
  LandmarkFactor factor{.node = node.id, .landmark = landmark};
  factor.position_in_robot = node_from_object.translation();
  factor.has_yaw = measurement.proposal.has_yaw;
  const double node_yaw = planarPart(node.world_from_robot).yaw;
  factor.yaw_in_robot = wrapAngle(planarPart(node.world_from_robot * node_from_object).yaw - node_yaw);
  // Without the uncertainty of the pose, which is the graph's own.
  const Eigen::Matrix4d in_world =
      measurementInWorld(measurement, decision.seen.camera, node.world_from_robot * node_from_camera, 0)
          .covariance;
  factor.covariance = rotateCovariance(in_world, node.world_from_robot.linear().transpose());
  factor.weight = decision.association.probability * measurement.confidence * measurement.proposal.score;
  return factor;
}

namespace {

constexpr std::size_t kMinViews = 3;  // key poses from which a point must be seen

// A point on a landmark, seen from one key pose.
struct PointView {
  PointId point;
  NodeId node;
  const ObjectFrame* frame;
  const FeatureTrack* feature;
};

// Measurements of one landmark.
struct Gathered {
  SightingsByNode sightings;
  std::map<NodeId, LandmarkBoxFactor> boxes;  // the best of each key pose
  std::vector<PointView> points;  // in the order of frames
};

constexpr double kPixelSigma = 2;        // of a box's side, px, however small the object
constexpr double kOwnShapeCovers = 0.7;  // IoU of a box with the shape that was lifted from it

double boxSigma(const Box2& box, double share) {
  return std::hypot(kPixelSigma, share * (box.width() + box.height()) / 2);
}

// The best box of each key pose. One that its own shape, placed by depth, does not explain bounds something
// else as well, or a part: the leaf of an open door, what shows above a table.
void gatherBox(const ObjectMeasurement& measurement, const PinholeCamera& camera,
               const LandmarkBoxFactor& seen, Gathered& out) {
  const Proposal& proposal = measurement.proposal;
  const auto own = projectShape(proposal.shape, proposal.camera_from_object, camera);
  if (!own || iou(own->visible, seen.box) < kOwnShapeCovers) return;
  LandmarkBoxFactor& best = out.boxes[seen.node];
  if (!best.landmark.valid() || seen.weight > best.weight) best = seen;
}

void gather(const ObjectFrame& frame, const ObjectDecision& decision, const Landmark& landmark,
            const KeyPose& node, const Pose3& node_from_camera, const BackendOptions& options, double trust,
            Gathered& out) {
  LandmarkFactor sighting = sightingOf(decision, landmark.id, node, node_from_camera);
  sighting.weight *= trust;
  const auto& measurement = decision.seen.measurement;
  out.sightings[node.id].push_back({sighting, &measurement.proposal, sighting.weight * visibleFraction(measurement)});
  gatherBox(measurement, frame.camera,
            {.node = node.id,
             .landmark = landmark.id,
             .camera = frame.camera,
             .robot_from_camera = node_from_camera,
             .box = measurement.detection.box,
             .sigma_px = boxSigma(measurement.detection.box, options.box_sigma),
             .weight = sighting.weight},
            out);
  std::vector<std::int64_t> own = measurement.features;
  std::sort(own.begin(), own.end());
  for (const auto& feature : frame.features)
    if (std::binary_search(own.begin(), own.end(), feature.point))
      out.points.push_back({PointId{feature.point}, node.id, &frame, &feature});
}

void addBoxes(const Gathered& seen, const Landmark& landmark, const KeyPoses& poses,
              const BackendOptions& options, ObjectFactors& out) {
  std::map<int, std::vector<LandmarkBoxFactor>> by_direction;
  for (const auto& [id, box] : seen.boxes)
    by_direction[directionOf(landmark.position, poses.node(id), options.landmark_view_rad)].push_back(box);
  for (const auto& [direction, all] : by_direction) {
    const auto boxes = thinned(all, kMostOfDirection);
    for (LandmarkBoxFactor box : boxes) {
      box.weight *= weightAmong(boxes.size(), options.landmark_repeating_share);
      out.boxes.push_back(box);
    }
  }
}

CameraPointFactor pointFactor(const PointView& view, const Pose3& node_from_camera, double sigma_px) {
  const double depth_m = view.feature->depth_m;
  return {.node = view.node,
          .point = view.point,
          .camera = view.frame->camera,
          .robot_from_camera = node_from_camera,
          .pixel = view.feature->pixel,
          .sigma_px = sigma_px,
          .depth_m = depth_m,
          .sigma_depth_m = sigma_px * (0.005 + 0.002 * depth_m * depth_m)};
}

// The first view of each point from each key pose, by points; within a point by key poses.
std::vector<PointView> firstViews(std::vector<PointView> views) {
  const auto key = [](const PointView& view) { return std::pair(view.point, view.node); };
  std::stable_sort(views.begin(), views.end(), [key](const auto& a, const auto& b) { return key(a) < key(b); });
  views.erase(std::unique(views.begin(), views.end(), [key](const auto& a, const auto& b) { return key(a) == key(b); }), views.end());
  return views;
}

// Views of one point, and behind them those of the next.
using PointViews = std::vector<PointView>::const_iterator;
PointViews endOfPoint(PointViews first, PointViews end) {
  return std::find_if(first, end, [first](const PointView& view) { return view.point != first->point; });
}

void addPoints(const Gathered& seen, const Landmark& landmark, const KeyPoses& poses, const BackendOptions& options,
               ObjectFactors& out) {
  const std::vector<PointView> views = firstViews(seen.points);
  std::vector<std::pair<PointViews, PointViews>> used;
  for (auto first = views.begin(); first != views.end();) {
    const auto end = endOfPoint(first, views.end());
    if (static_cast<std::size_t>(end - first) >= kMinViews && !out.points.contains(first->point) &&
        used.size() < static_cast<std::size_t>(options.points_per_landmark))
      used.emplace_back(first, end);
    first = end;
  }
  for (const auto& [first, end] : used) {
    Eigen::Vector3d middle = Eigen::Vector3d::Zero();
    for (auto view = first; view != end; ++view) {
      const KeyPose& node = poses.node(view->node);
      const Pose3 node_from_camera = poses.offset(node, view->frame->t) * view->frame->robot_from_camera;
      const FeatureTrack& feature = *view->feature;
      const Eigen::Vector3d in_camera = view->frame->camera.backProject(feature.pixel.x(), feature.pixel.y(), feature.depth_m);
      middle += node.world_from_robot * node_from_camera * in_camera / static_cast<double>(end - first);
      out.point_views.push_back(pointFactor(*view, node_from_camera, options.point_sigma_px));
    }
    out.points[first->point] = middle;
    if (!options.points_inside) continue;
    out.insides.push_back({.point = first->point,
                           .landmark = landmark.id,
                           .weight = weightAmong(used.size(), options.landmark_repeating_share)});
  }
}

}  // namespace

ObjectFactors objectFactors(const ObjectFrames& frames, const KeyPoses& poses,
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
      // By the poses of now: those of when it was decided may have been elsewhere.
      const WorldMeasurement seen = measurementInWorld(decision.seen.measurement, decision.seen.camera,
                                                       node.world_from_robot * node_from_camera, options.pose_sigma_m);
      const double trust = model ? model->depthTrust(seen, landmark) : 1;
      gather(frame, decision, landmark, node, node_from_camera, options, trust, gathered[landmark.id]);
    }
  }
  ObjectFactors out;
  for (const auto& [id, seen] : gathered) {
    const Landmark& landmark = *known.at(id);
    const ObjectModel* usual = database.find(landmark.class_name);
    if (!addViews(seen.sightings, landmark, usual, poses, options, out)) continue;
    if (options.object_boxes) addBoxes(seen, landmark, poses, options, out);
    addPoints(seen, landmark, poses, options, out);
  }
  return out;
}

}  // namespace roomgraph
