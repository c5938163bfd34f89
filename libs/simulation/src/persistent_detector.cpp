// SPDX-License-Identifier: BSD-3-Clause
// Slow errors of a simulated detector: misses, wrong labels, jitter, duplicates and phantoms.
#include "persistent_detector.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace roomgraph {
namespace {

constexpr std::uint64_t kOwnStream = 101, kFreshStream = 102;
// Standard deviations of the parts of an error: of the object, of the view, of the moment. Their squares sum
// to 1.
constexpr double kOfObject = 0.6, kOfView = 0.65, kOfMoment = 0.4664;
// Purposes of an object's errors: labels from 0, the four edges, the second box.
constexpr int kEdges = 20, kDuplicate = 30;

/// Place among the values of the standard normal distribution, in (0, 1).
double rank(double normal) {
  return 0.5 * std::erfc(-normal / std::numbers::sqrt2);
}

ViewPoint viewOf(const Pose3& world_from_object, const Pose3& world_from_camera) {
  const Eigen::Vector3d at = world_from_object.inverse() * world_from_camera.translation();
  return {std::atan2(at.y(), at.x()), std::log(std::max(0.3, at.norm()))};
}

void addBox(CObservationDetections& out, const PinholeCamera& camera, const std::string& label, double score,
            const Eigen::Vector4d& box) {
  CObservationDetections::Item item;
  item.label = label;
  item.score = static_cast<float>(std::clamp(score, 0.2, 0.98));
  item.u_min = std::clamp(box[0], 0.0, camera.width - 2.0);
  item.v_min = std::clamp(box[1], 0.0, camera.height - 2.0);
  item.u_max = std::clamp(box[2], item.u_min + 1.0, static_cast<double>(camera.width));
  item.v_max = std::clamp(box[3], item.v_min + 1.0, static_cast<double>(camera.height));
  out.items.push_back(item);
}

}  // namespace

const std::vector<LabelChance>& labelChances(const std::string& class_name, const std::string& kind) {
  using Chances = std::vector<LabelChance>;
  static const std::map<std::string, Chances> all{
      {"swivel_chair", {{"chair", 1, true}, {"couch", 0.02}}},
      {"sofa", {{"couch", 1, true}, {"chair", 0.1}, {"bed", 0.05}}},
      {"door", {{"door", 1, true}}},
      {"person", {{"person", 1, true}}},
      {"bed", {{"bed", 1, true}, {"couch", 0.2}}},
      {"table", {{"dining table", 0.8, true}, {"chair", 0.02}}},
      {"round table", {{"dining table", 0.8, true}, {"chair", 0.02}}},
      {"cupboard", {{"cabinet", 0.8, true}, {"door", 0.15}}},
      {"refrigerator", {{"refrigerator", 0.9, true}, {"door", 0.12}}},
      {"wooden chair", {{"chair", 0.95, true}}},
      {"visitor chair", {{"chair", 0.97, true}}},
      {"armchair", {{"chair", 0.55}, {"couch", 0.45}}},
      {"stool", {{"chair", 0.35}}},
      {"bench", {{"bench", 0.6, true}, {"couch", 0.25}, {"chair", 0.12}}},
      {"printer", {{"chair", 0.06}}},
      {"coat stand", {{"person", 0.25}, {"chair", 0.03}}},
      {"whiteboard", {{"tv", 0.4}, {"door", 0.1}}},
      {"cabinet", {{"cabinet", 0.6, true}, {"door", 0.12}}},
      {"shelf", {{"door", 0.06}}},
      {"plant", {{"potted plant", 0.85, true}, {"chair", 0.03}}},
      {"monitor", {{"tv", 0.85, true}, {"chair", 0.02}}},
      {"desk", {{"dining table", 0.5, true}, {"couch", 0.02}}},
      {"bin", {{"chair", 0.05}}},
      {"box", {{"chair", 0.05}, {"couch", 0.03}}}};
  static const Chances none;
  auto found = all.find(kind);
  if (found == all.end()) found = all.find(class_name);
  return found == all.end() ? none : found->second;
}

SlowError::SlowError(Random own) : offset_(own.normal()) {
  for (auto& wave : waves_) {
    // Whole turns: the error is the same after walking once around the object.
    wave.turns = std::floor(own.uniform(0, 4));
    wave.depth = own.uniform(-4, 4);
    wave.phase = own.uniform(0, 2 * std::numbers::pi);
  }
}

double SlowError::at(const ViewPoint& view, double seconds, double memory_s, Random& fresh) {
  const double kept = seen_ && memory_s > 0 ? std::exp(-(seconds - last_s_) / memory_s) : 0;
  changing_ = kept * changing_ + std::sqrt(1 - kept * kept) * fresh.normal();
  last_s_ = seconds;
  seen_ = true;
  double field = 0;
  for (const auto& wave : waves_)
    field += std::cos(wave.turns * view.azimuth_rad + wave.depth * view.log_range + wave.phase);
  return kOfObject * offset_ + kOfView * std::sqrt(2.0 / kWaves) * field + kOfMoment * changing_;
}

PersistentDetector::PersistentDetector(const Scene& scene, const PinholeCamera& camera, const DetectionsSpec& spec,
                                       std::uint64_t seed)
    : scene_(scene), camera_(camera), spec_(spec), seed_(seed) {}

double PersistentDetector::error(int object, int purpose, const ViewPoint& view, double seconds, Random& fresh) {
  const std::pair key(object, purpose);
  auto found = errors_.find(key);
  if (found == errors_.end()) {
    const auto index = static_cast<std::uint64_t>(static_cast<std::int64_t>(object) * 64 + purpose);
    found = errors_.emplace(key, SlowError(Random(seed_, kOwnStream, index))).first;
  }
  return found->second.at(view, seconds, spec_.memory_s, fresh);
}

void PersistentDetector::detectObject(const ObjectView& seen, const ViewPoint& view, double seconds, Random& fresh,
                                      CObservationDetections& out) {
  const auto& object = scene_.objects()[static_cast<std::size_t>(seen.object)];
  const auto now = [&](int purpose) { return error(seen.object, purpose, view, seconds, fresh); };
  const Eigen::Vector4d truth(seen.box.x, seen.box.y, seen.box.br().x, seen.box.br().y);
  Eigen::Vector4d box;
  for (int edge = 0; edge < 4; ++edge) {
    const int size = edge % 2 == 0 ? seen.box.width : seen.box.height;
    box[edge] = truth[edge] + spec_.jitter * size * (0.93 * now(kEdges + edge) + 0.3676 * fresh.normal());
  }
  // Small and hidden things are missed more often.
  const double size = std::min(1.0, 0.5 + 0.5 * (seen.box.height - spec_.min_height_px) / (2 * spec_.min_height_px));
  const double well = size * (0.5 + 0.5 * seen.visible);
  const double second = rank(now(kDuplicate));
  int purpose = 0;
  for (const auto& chance : labelChances(object.class_name, object.kind)) {
    const double gain = chance.own ? spec_.detect_probability : spec_.mislead;
    const double likely = std::min(1.0, chance.probability * gain * well), place = rank(now(purpose++));
    if (place >= likely) continue;
    const double margin = 1 - place / likely;  // the surer, the higher the score
    const double score = (chance.own ? 0.35 + 0.35 * well + 0.25 * margin : 0.28 + 0.12 * well + 0.3 * margin) +
                         0.03 * fresh.normal();
    addBox(out, camera_, chance.label, score, box);
    if (!chance.own || second >= spec_.duplicates) continue;
    // The second box holds a part only: the upper one or the lower one.
    Eigen::Vector4d part = box;
    const double cut = (0.25 + 0.2 * second / spec_.duplicates) * seen.box.height;
    if (object.id % 2 == 0)
      part[1] += cut;
    else
      part[3] -= cut;
    addBox(out, camera_, chance.label, 0.7 * score, part);
  }
}

void PersistentDetector::maybeNewPhantom(const IdImage& exact, const Pose3& world_from_camera, Random& fresh) {
  constexpr double kBirths = 0.04;  // per false alarm and frame: each is seen in many frames
  static const std::vector<std::string> labels{"chair", "couch", "person", "door", "potted plant", "tv"};
  if (!fresh.chance(kBirths * spec_.false_positives)) return;
  const int u = static_cast<int>(fresh.uniform(0.1, 0.9) * camera_.width),
            v = static_cast<int>(fresh.uniform(0.2, 0.8) * camera_.height);
  const double depth = exact.depth.at<float>(v, u);
  if (exact.object.at<std::int16_t>(v, u) >= 0 || depth < 0.8) return;
  Phantom born;
  born.at = world_from_camera * camera_.backProject(u, v, depth);
  const Eigen::Vector3d ray = born.at - world_from_camera.translation();
  born.range_m = ray.norm();
  born.direction = ray / born.range_m;
  born.width_m = fresh.uniform(0.3, 1.0);
  born.height_m = fresh.uniform(0.4, 1.3);
  born.label = labels[static_cast<std::size_t>(fresh.uniform() * static_cast<double>(labels.size()))];
  phantoms_.push_back(born);
}

void PersistentDetector::detectPhantoms(const IdImage& exact, const Pose3& world_from_camera, double seconds,
                                        Random& fresh, CObservationDetections& out) {
  constexpr double kSameDirection = 0.82, kSameRange = 0.5, kShown = 0.6;  // cosine; natural logarithm; share
  for (std::size_t i = 0; i < phantoms_.size(); ++i) {
    const Phantom& phantom = phantoms_[i];
    const Eigen::Vector3d p = world_from_camera.inverse() * phantom.at,
                          ray = phantom.at - world_from_camera.translation();
    if (p.z() < 0.5) continue;
    const double u = camera_.cx + camera_.fx * p.x() / p.z(), v = camera_.cy + camera_.fy * p.y() / p.z();
    if (u < 0 || v < 0 || u >= camera_.width - 1 || v >= camera_.height - 1) continue;
    const double depth = exact.depth.at<float>(static_cast<int>(v), static_cast<int>(u));
    const double farther = std::log(ray.norm() / phantom.range_m);
    if (std::abs(depth - p.z()) > 0.1 + 0.05 * p.z() || std::abs(farther) > kSameRange ||
        ray.normalized().dot(phantom.direction) < kSameDirection)
      continue;
    const double place = rank(error(-1 - static_cast<int>(i), 0, {0, farther}, seconds, fresh));
    if (place >= kShown) continue;
    const double w = camera_.fx * phantom.width_m / p.z() / 2, h = camera_.fy * phantom.height_m / p.z() / 2;
    addBox(out, camera_, phantom.label, 0.28 + 0.25 * (1 - place / kShown) + 0.03 * fresh.normal(),
           {u - w, v - h, u + w, v + h});
  }
}

CObservationDetections PersistentDetector::detect(const IdImage& exact, const Pose3& world_from_camera,
                                                  double seconds, int index) {
  CObservationDetections out;
  out.image_width = static_cast<std::uint32_t>(camera_.width);
  out.image_height = static_cast<std::uint32_t>(camera_.height);
  out.model = "simulator";
  Random fresh(seed_, kFreshStream, static_cast<std::uint64_t>(index));
  std::map<int, Pose2> moving;
  for (const auto& [object, pose] : scene_.persons(seconds)) moving[object] = pose;
  for (const auto& seen : exact.views) {
    if (seen.visible < spec_.min_visible || seen.box.height < spec_.min_height_px) continue;
    const auto person = moving.find(seen.object);
    const Pose3 pose = person != moving.end() ? toPose3(person->second)
                                              : scene_.worldFromObject(seen.object, seconds);
    detectObject(seen, viewOf(pose, world_from_camera), seconds, fresh, out);
  }
  maybeNewPhantom(exact, world_from_camera, fresh);
  detectPhantoms(exact, world_from_camera, seconds, fresh, out);
  return out;
}

}  // namespace roomgraph
