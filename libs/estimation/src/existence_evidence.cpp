// SPDX-License-Identifier: BSD-3-Clause
// Means over a landmark's sightings, and boxes that others explain.
#include "existence_evidence.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <tuple>

#include "direction_bin.h"
#include "moved_landmarks.h"
#include "ray_evidence.h"
#include "roomgraph/association/landmark_rules.h"
#include "roomgraph/core/order_statistics.h"
#include "roomgraph/geometry/projection.h"
#include "roomgraph/geometry/shape_math.h"

namespace roomgraph {
namespace {

constexpr double kDirection_rad = 0.26;
constexpr double kCovered = 0.7;  // of a box, by the landmark that explains it
constexpr double kSameBox = 0.7;  // IoU of two boxes of a frame that bound the same thing
constexpr double kOtherYaw_rad = 0.35;
constexpr double kLeastScatter = 0.05;
constexpr double kSameMoment_s =
    0.35;                        // between an image and a box of the same view; not every image is searched
constexpr int kEstablished = 6;  // sightings of a landmark that may explain boxes of others

// What the sightings from one direction say about the longer side, weighted sums.
struct LengthSeen {
  double weight = 0, information = 0;  // 1/m^2
};

// Sums of the weights of sightings that have a yaw, and of those whose yaw is another one.
struct YawsSeen {
  double weight = 0, turned = 0;
};

struct SightingSums {
  int count = 0, contested = 0, placed = 0;
  double weight = 0, score = 0, confidence = 0, outdone = 0,
         mislabelled = 0;  // weighted by the sightings' weights
  double scatter = 0;
  YawsSeen yaws, in_good_view;
  std::map<NodeId, double> at_nodes;  // the largest weight at each key pose
  std::map<int, LengthSeen> lengths;  // by direction
  std::set<double> times;             // s
};

double normalisedDistance2(const Landmark& landmark, const WorldMeasurement& seen) {
  const Eigen::Vector2d offset = (seen.world_from_object.translation() - landmark.position).head<2>();
  return offset.dot(seen.covariance.topLeftCorner<2, 2>().inverse() * offset);
}

// Front and back are easily confused and do not count.
bool isTurned(double difference_rad) {
  return std::abs(std::sin(difference_rad)) > std::sin(kOtherYaw_rad);
}

// Index of the width or the depth.
int longerSide(const ObjectShape& shape) {
  return shape.width >= shape.depth ? 0 : 1;
}

// A sofa for two still is one.
double shorterBy(const ObjectShape& shape, const ObjectModel& model) {
  constexpr double kUsual = 2;  // standard deviations
  const int side = longerSide(model.nominal());
  return std::max(0.0, (sizeOf(model.nominal()) - sizeOf(shape))[side] / model.sizeSigma()[side] - kUsual);
}

// Share of the information on the longer side that is the sightings'; those from one direction repeat their
// errors and count as their mean.
double measuredShare(const SightingSums& sums, const ObjectModel& model, const ObjectShape& shape) {
  double measured = 0;
  for (const auto& [direction, seen] : sums.lengths)
    if (seen.weight > 0) measured += seen.information / seen.weight;
  const double sigma_m = model.sizeSigma()[longerSide(shape)];
  return measured / (measured + 1 / (sigma_m * sigma_m));
}

// Share of the box that the landmark's projection covers.
double coveredShare(const Box2& box, const Landmark& landmark, const Pose3& camera_from_world,
                    const PinholeCamera& camera) {
  const auto projected = projectShape(landmark.shape, camera_from_world * landmark.worldFromObject(), camera);
  if (!projected || box.area() <= 0) return 0;
  return intersection(box, projected->visible).area() / box.area();
}

// First image that is not before `t`.
std::vector<SearchedImage>::const_iterator firstFrom(const std::vector<SearchedImage>& searched, double t) {
  return std::lower_bound(searched.begin(), searched.end(), t, [](const SearchedImage& image, double from) { return image.t < from; });
}

// That of time `t`; one in which everything was looked for where it is not known.
SearchedImage imageAt(const std::vector<SearchedImage>& searched, double t) {
  const auto image = firstFrom(searched, t);
  return image != searched.end() && image->t == t ? *image : SearchedImage{};
}

// Of the times `views` those near which the landmark's class was looked for, or nothing was searched.
std::vector<double> lookedForIn(std::vector<double> views, const Landmark& landmark, const std::vector<SearchedImage>& searched) {
  std::erase_if(views, [&](double t) {
    const auto first = firstFrom(searched, t - kSameMoment_s), last = firstFrom(searched, t + kSameMoment_s);
    return first != last && std::all_of(first, last, [&](const auto& image) { return image.without(landmark.class_name); });
  });
  return views;
}

// Landmarks that may explain boxes of others, as they have none of their own in this frame.
std::vector<const Landmark*> unseenHere(const std::vector<Landmark>& landmarks, const ObjectFrame& frame,
                                        const SearchedImage& image) {
  std::set<LandmarkId> here;
  for (const auto& decision : frame.decisions) here.insert(decision.landmark);
  std::vector<const Landmark*> out;
  for (const auto& landmark : landmarks)
    if (!here.contains(landmark.id) && landmark.observations >= kEstablished && !image.without(landmark.class_name))
      out.push_back(&landmark);
  return out;
}

// A detector may give one thing two labels, each in a box of its own; both are lifted, and one shape fits
// better.
bool isOutdone(const ObjectDecision& decision, const ObjectFrame& frame) {
  const auto& own = decision.seen.measurement;
  return std::any_of(frame.decisions.begin(), frame.decisions.end(), [&](const ObjectDecision& other) {
    const auto& rival = other.seen.measurement;
    return other.landmark != decision.landmark && rival.proposal.class_name != own.proposal.class_name &&
           rival.proposal.score > own.proposal.score &&
           iou(rival.detection.box, own.detection.box) > kSameBox;
  });
}

// `views`: times, sorted.
bool within(const std::vector<double>& views, double t) {
  const auto next = std::lower_bound(views.begin(), views.end(), t - kSameMoment_s);
  return next != views.end() && *next <= t + kSameMoment_s;
}

void add(SightingSums& sums, const Landmark& landmark, const WorldMeasurement& seen, NodeId node, double t,
         const Eigen::Vector3d& camera_in_world, const std::vector<double>& good_views) {
  const double weight = sightingWeight(seen.measurement);
  const Proposal& proposal = seen.measurement.proposal;
  ++sums.count;
  sums.times.insert(t);
  sums.weight += weight;
  sums.score += weight * proposal.score;
  sums.confidence += weight * seen.measurement.detection.score;
  sums.at_nodes[node] = std::max(sums.at_nodes[node], weight);
  LengthSeen& length =
      sums.lengths[directionBin((camera_in_world - landmark.position).head<2>(), kDirection_rad)];
  length.weight += weight;
  if (proposal.class_name != landmark.class_name) return;
  ++sums.placed;
  sums.scatter += normalisedDistance2(landmark, seen);
  const bool turned = proposal.has_yaw && isTurned(planarPart(seen.world_from_object).yaw - landmark.yaw);
  // One that took width for depth does not measure the length.
  if (!turned) length.information += weight * proposal.size_information[longerSide(landmark.shape)];
  if (!proposal.has_yaw) return;
  const double turned_weight = turned ? weight : 0;
  sums.yaws.weight += weight, sums.yaws.turned += turned_weight;
  if (!within(good_views, t)) return;
  sums.in_good_view.weight += weight, sums.in_good_view.turned += turned_weight;
}

using GoodViews = std::map<LandmarkId, std::vector<double>>;  // times, sorted, s

std::map<LandmarkId, SightingSums> sumsBySightings(const std::vector<Landmark>& landmarks,
                                                   const ObjectFrames& frames,
                                                   const KeyPoses& poses, const GoodViews& good_views,
                                                   const std::vector<SearchedImage>& searched) {
  std::map<LandmarkId, const Landmark*> known;
  for (const auto& landmark : landmarks) known[landmark.id] = &landmark;
  std::map<LandmarkId, SightingSums> out;
  for (const auto& frame : frames) {
    const Pose3 world_from_camera = poses.at(frame.t) * frame.robot_from_camera;
    const Pose3 camera_from_world = world_from_camera.inverse();
    const auto others = unseenHere(landmarks, frame, imageAt(searched, frame.t));
    for (const auto& decision : frame.decisions) {
      const auto found = known.find(decision.landmark);
      if (found == known.end()) continue;
      const Landmark& landmark = *found->second;
      SightingSums& sums = out[landmark.id];
      add(sums, landmark, decision.seen, poses.nearest(frame.t).id, frame.t, world_from_camera.translation(),
          good_views.at(landmark.id));
      const Detection& detection = decision.seen.measurement.detection;
      const double weight = sightingWeight(decision.seen.measurement);
      if (isOutdone(decision, frame)) sums.outdone += weight;
      if (detection.rival_score > detection.score) sums.mislabelled += weight;
      sums.contested += std::any_of(others.begin(), others.end(), [&](const Landmark* other) {
        return other->observations >= landmark.observations &&
               coveredShare(detection.box, *other, camera_from_world, frame.camera) > kCovered;
      });
    }
  }
  return out;
}

// What this detector calls sure: scores of one are probabilities, those of another hardly exceed .7.
double sureScore(const ObjectFrames& frames) {
  constexpr double kUpperQuartile = 0.75;
  std::vector<double> scores;
  for (const auto& frame : frames)
    for (const auto& decision : frame.decisions) scores.push_back(decision.seen.measurement.detection.score);
  return quantile(std::move(scores), kUpperQuartile);
}

void setSightings(ExistenceEvidence& evidence, const SightingSums& sums, double sure_score) {
  if (sums.weight <= 0) return;
  double of_nodes = 0;
  for (const auto& [node, weight] : sums.at_nodes) of_nodes += weight;
  evidence.sightings = std::log1p(of_nodes);
  evidence.directions = std::log(static_cast<double>(sums.lengths.size()));
  evidence.score = sums.score / sums.weight;
  if (sure_score > 0) evidence.confidence = std::min(1.0, sums.confidence / sums.weight / sure_score);
  evidence.contested = static_cast<double>(sums.contested) / sums.count;
  evidence.mislabelled = sums.mislabelled / sums.weight;
  evidence.outdone = sums.outdone / sums.weight;
  evidence.scatter = std::log(kLeastScatter + (sums.placed ? sums.scatter / sums.placed : 0));
  // What is far off or half hidden is often laid across: that says little about the object.
  const YawsSeen& yaws = sums.in_good_view.weight > 0 ? sums.in_good_view : sums.yaws;
  evidence.turned = yaws.weight > 0 ? yaws.turned / yaws.weight : 0;
}

// Each place counts once: errors of a detector repeat while the view is the same. One of each is added, so
// that few places say little.
double detectionLogOdds(const std::set<double>& sighting_times, const std::vector<double>& times_in_view) {
  const auto detected = std::count_if(times_in_view.begin(), times_in_view.end(), [&](double t) {
    const auto next = sighting_times.lower_bound(t - kSameMoment_s);
    return next != sighting_times.end() && *next <= t + kSameMoment_s;
  });
  const auto missed = static_cast<std::ptrdiff_t>(times_in_view.size()) - detected;
  return std::log(static_cast<double>(detected + 1) / static_cast<double>(missed + 1));
}

bool isSamePlace(const Pose2& a, const Pose2& b) {
  constexpr double kNear_m = 0.5, kNear_rad = 0.35;
  return std::hypot(a.x - b.x, a.y - b.y) < kNear_m && std::abs(wrapAngle(a.yaw - b.yaw)) < kNear_rad;
}

// After somebody carried it away, places from which it was seen before show that it is gone. A detector errs the same way for the time of a
// visit; five of these say all that misses can.
double missedSince(const std::set<double>& sighting_times, const std::vector<double>& times_in_view, const KeyPoses& poses) {
  constexpr int kMost = 5;
  constexpr double kVisit_s = 30;
  if (sighting_times.empty()) return 0;
  double last = *sighting_times.rbegin();
  auto later = std::upper_bound(times_in_view.begin(), times_in_view.end(), last + kVisit_s);
  if (later == times_in_view.end()) return 0;
  std::vector<Pose2> seen_from;
  for (const double t : sighting_times) seen_from.push_back(planarPart(poses.at(t)));
  int missed = 0;
  for (; later != times_in_view.end() && missed < kMost; ++later) {
    if (*later < last + kVisit_s) continue;
    const Pose2 now = planarPart(poses.at(*later));
    if (std::none_of(seen_from.begin(), seen_from.end(), [&now](const Pose2& then) { return isSamePlace(now, then); })) continue;
    ++missed;
    last = *later;
  }
  return missed;
}

}  // namespace

std::vector<ExistenceEvidence> existenceEvidence(const std::vector<Landmark>& landmarks,
                                                 const ObjectFrames& frames,
                                                 const KeyPoses& poses, const PosedViews& views,
                                                 const ObjectDatabase& database,
                                                 const std::vector<SearchedImage>& searched) {
  GoodViews good_views;
  std::map<LandmarkId, PosedViews> of_moved;  // what was seen of where it stands before it stood there is of something else
  for (const auto& landmark : landmarks)
    if (landmark.stands_since) of_moved[landmark.id] = views.between(*landmark.stands_since, std::numeric_limits<double>::infinity());
  const auto viewsOf = [&](const Landmark& landmark) -> const PosedViews& {
    return landmark.stands_since ? of_moved.at(landmark.id) : views;
  };
  for (const auto& landmark : landmarks)
    good_views[landmark.id] = lookedForIn(viewsOf(landmark).timesInGoodView(landmark), landmark, searched);
  auto sums = sumsBySightings(landmarks, frames, poses, good_views, searched);
  for (const auto& sighting : frames.former()) sums[sighting.landmark].times.insert(sighting.t);
  const double sure_score = sureScore(frames);
  std::vector<ExistenceEvidence> out;
  for (const auto& landmark : landmarks) {
    ExistenceEvidence evidence;
    evidence.filter = std::clamp(std::log(landmark.existence / (1 - landmark.existence)), -4.0, 4.0);
    setSightings(evidence, sums[landmark.id], sure_score);
    evidence.detected = detectionLogOdds(sums[landmark.id].times, good_views[landmark.id]);
    evidence.missed_since = missedSince(sums[landmark.id].times, good_views[landmark.id], poses);
    if (const auto own = landmark.class_posterior.find(landmark.class_name);
        own != landmark.class_posterior.end())
      evidence.label = own->second;
    const ObjectModel* model = database.find(landmark.class_name);
    if (model) {
      evidence.size = std::sqrt(model->sizeDistance2(landmark.shape));
      evidence.shorter = shorterBy(landmark.shape, *model);
      evidence.measured = measuredShare(sums[landmark.id], *model, landmark.shape);
    }
    setRays(evidence, landmark, model ? model->solid_share : 0, viewsOf(landmark));
    if (const auto& times = sums[landmark.id].times; landmark.shape.kind != ShapeKind::kPlanar && !times.empty())
      evidence.emptied = emptiedSince(*times.rbegin(), landmark, viewsOf(landmark));
    out.push_back(evidence);
  }
  return out;
}

PlaceLook lookAt(const Landmark& landmark, const PosedViews& views, const std::vector<double>& searched,
                 const std::vector<double>& sighted, const ObjectDatabase& database) {
  PlaceLook look;
  for (const double t : views.timesInGoodView(landmark))
    look.missed += within(searched, t) && !within(sighted, t);
  // An open door is crossed, too; that it is gone, the wall around it shows.
  if (landmark.shape.kind == ShapeKind::kPlanar) return look;
  const ObjectModel* model = database.find(landmark.class_name);
  setRays(look, landmark, model ? model->solid_share : 0, views);
  return look;
}

}  // namespace roomgraph
