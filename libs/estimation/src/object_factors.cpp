// SPDX-License-Identifier: BSD-3-Clause
// Grouping of sightings by key pose, side and visit; their means and weights.
#include "roomgraph/estimation/object_factors.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <optional>
#include <utility>

#include "measurement_in_world.h"
#include "object_weights.h"
#include "roomgraph/association/landmark_rules.h"
#include "roomgraph/geometry/covariance.h"
#include "roomgraph/geometry/projection.h"
#include "sighting_mean.h"
#include "size_mean.h"

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

// Of the mean of sightings, in widths of the loss of one of them: what is cut off is another depth, not scatter.
constexpr double kMeanWidth = 3;
constexpr std::size_t kMinViews = 3;  // key poses from which a point must be seen

// A point on a landmark, seen from one key pose.
struct PointView {
  PointId point;
  NodeId node;
  const ObjectFrame* frame;
  const FeatureTrack* feature;
};

// A proposal that measures the size, if its yaw is the landmark's; else width and depth may have changed
// places.
struct SizeSeen {
  const Proposal* proposal;
  double yaw_in_robot, weight;
  double share;  // of the sighting in a mean place
};

// Measurements of one landmark.
struct Gathered {
  std::map<NodeId, std::vector<LandmarkFactor>> sightings;
  std::map<NodeId, std::vector<SizeSeen>> sizes;
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
  sighting.covariance *= options.landmark_sigma_share * options.landmark_sigma_share;
  out.sightings[node.id].push_back(sighting);
  const auto& measurement = decision.seen.measurement;
  out.sizes[node.id].push_back({&measurement.proposal, sighting.yaw_in_robot,
                                sighting.weight * visibleFraction(measurement), shareOfPlace(sighting)});
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

// Landmarks of the graph that stand for views; the map's own never get that far.
constexpr std::int64_t kFirstView = 1'000'000'000;
constexpr int kDirections = 1024;      // more than there are of the least landmark_view_rad
constexpr double kLeastWeight = 1e-9;  // a view without weight would leave its place undetermined
constexpr double kVisitPause_s = 3;    // an object not seen for so long begins a new visit

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
std::optional<double> votedYaw(const Gathered& seen, const KeyPoses& poses) {
  std::complex<double> doubled = 0, single = 0;
  for (const auto& [id, group] : seen.sightings) {
    const double node_yaw = planarPart(poses.node(id).world_from_robot).yaw;
    for (const LandmarkFactor& s : group) {
      if (!s.has_yaw) continue;
      const double vote = s.weight / (kSurestYaw + s.covariance(3, 3));
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

// Sightings from one key pose; yaws of the other direction are reversed, those across do not measure the yaw.
std::vector<LandmarkFactor> withYawsNear(double yaw_in_robot, std::vector<LandmarkFactor> sightings) {
  for (LandmarkFactor& s : sightings) {
    if (std::abs(wrapAngle(s.yaw_in_robot - yaw_in_robot)) > std::numbers::pi / 2)
      s.yaw_in_robot = wrapAngle(s.yaw_in_robot + std::numbers::pi);
    s.has_yaw &= !isAcross(s.yaw_in_robot - yaw_in_robot);
  }
  return sightings;
}

using Visit = std::vector<LandmarkFactor>;  // sightings from one direction in a row, placed in world

// What was seen from one direction.
struct View {
  std::vector<Visit> visits;
  SizeMean size;
  OffsetMean offset;
};

// Of a place (world) from a key pose, in steps of the angle.
int directionOf(const Eigen::Vector3d& place, const KeyPose& node, double angle_rad) {
  const Eigen::Vector3d ray = place - node.world_from_robot.translation();
  return static_cast<int>(std::floor(std::atan2(ray.y(), ray.x()) / angle_rad));
}

std::map<int, View> viewsByDirection(const Gathered& seen, const ObjectModel* usual, const KeyPoses& poses,
                                     double yaw, const BackendOptions& options) {
  std::map<int, View> views;
  for (const auto& [id, group] : seen.sightings) {
    const KeyPose& node = poses.node(id);
    const double yaw_in_robot = yaw - planarPart(node.world_from_robot).yaw;
    const LandmarkFactor sighting =
        inWorld(meanSighting(withYawsNear(yaw_in_robot, group), kMeanWidth * options.landmark_robust_width),
                node.world_from_robot);
    if (sighting.weight < kLeastWeight) continue;
    View& view = views[directionOf(sighting.position_in_robot, node, options.landmark_view_rad)];
    // A robot that stands still makes few key poses: a visit ends only when key poses in between do not see
    // the object.
    const bool gone =
        view.visits.empty() || (id.value - view.visits.back().back().node.value > 1 &&
                                node.t - poses.node(view.visits.back().back().node).t > kVisitPause_s);
    if (gone) view.visits.emplace_back();
    view.visits.back().push_back(sighting);
    if (!usual) continue;
    for (const auto& [proposal, seen_yaw, weight, share] : seen.sizes.at(id)) {
      const bool across = proposal->has_yaw && isAcross(seen_yaw - yaw_in_robot);
      if (!across) view.size.add(*proposal, *usual, weight);
      if (across || !proposal->has_yaw) {
        view.offset.add(share);
      } else {
        view.offset.add(*proposal, seen_yaw - yaw_in_robot, share);
      }
    }
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
LandmarkId viewId(LandmarkId landmark, int direction) {
  return LandmarkId{kFirstView + landmark.value * kDirections + kDirections / 2 + direction};
}

// Returns whether there is a view that ties the landmark to the key poses.
bool addViews(const Gathered& seen, const Landmark& landmark, const ObjectModel* usual, const KeyPoses& poses,
              const BackendOptions& options, ObjectFactors& out) {
  const double yaw = votedYaw(seen, poses).value_or(landmark.yaw);
  const auto views = viewsByDirection(seen, usual, poses, yaw, options);
  for (const auto& [direction, view] : views) {
    std::vector<LandmarkFactor> visits;
    const LandmarkId id = viewId(landmark.id, direction);
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
    if (landmark.has_yaw) view.offset.apply(out.shared_errors.back());
  }
  if (views.empty()) return false;
  out.yaws[landmark.id] = yaw;
  if (options.object_sizes && usual) out.sizes.push_back(sizePrior(landmark.id, *usual));
  return true;
}

void addBoxes(const Gathered& seen, const Landmark& landmark, const KeyPoses& poses,
              const BackendOptions& options, ObjectFactors& out) {
  std::map<int, std::vector<LandmarkBoxFactor>> by_direction;
  for (const auto& [id, box] : seen.boxes)
    by_direction[directionOf(landmark.position, poses.node(id), options.landmark_view_rad)].push_back(box);
  for (auto& [direction, boxes] : by_direction) {
    for (LandmarkBoxFactor& box : boxes) {
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
      const double trust = model ? model->depthTrust(decision.seen, landmark) : 1;
      gather(frame, decision, landmark, node, node_from_camera, options, trust, gathered[landmark.id]);
    }
  }
  ObjectFactors out;
  for (const auto& [id, seen] : gathered) {
    const Landmark& landmark = *known.at(id);
    const ObjectModel* usual = database.find(landmark.class_name);
    if (!addViews(seen, landmark, usual, poses, options, out)) continue;
    if (options.object_boxes) addBoxes(seen, landmark, poses, options, out);
    addPoints(seen, landmark, poses, options, out);
  }
  return out;
}

}  // namespace roomgraph
