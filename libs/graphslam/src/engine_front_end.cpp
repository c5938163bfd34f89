// SPDX-License-Identifier: BSD-3-Clause
// Records through the front ends, movements by all sources, closures between the engine's nodes.
#include "roomgraph/graphslam/engine_front_end.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "object_front_end.h"
#include "roomgraph/estimation/graph_builder.h"
#include "roomgraph/pipeline/read_options.h"

namespace roomgraph {
namespace {

constexpr double kSilence_s = 0.25;  // a source that was silent for longer does not cover the time

// False for a stamp that does not come after the last one.
bool advance(std::optional<double>& last, double t) {
  if (last && t <= *last) return false;
  last = t;
  return true;
}

// Poses are asked for by the stamps that the engine reads.
ReadOptions withStampsAsRecorded(ReadOptions options) {
  options.continue_time = false;
  return options;
}

}  // namespace

EngineFrontEnd::EngineFrontEnd(std::unique_ptr<Setup> setup, const std::filesystem::path& recording)
    : setup_(std::move(setup)),
      converter_(withStampsAsRecorded(readOptionsOf(setup_->options)), recording),
      front_ends_(setup_->stages, setup_->options),
      poses_(front_ends_.motion()) {}
EngineFrontEnd::~EngineFrontEnd() = default;

void EngineFrontEnd::take(const std::vector<mrpt::serialization::CSerializable::Ptr>& step) {
  if (step == latest_step_) return;
  latest_step_ = step;
  for (const auto& object : step)
    if (object) converter_.take(object);
  drain();
}

void EngineFrontEnd::end() {
  converter_.end();
  drain();
  if (objects_) objects_->end();
}

void EngineFrontEnd::drain() {
  while (const auto record = converter_.next()) {
    process(*record);
    if (objects_) objects_->process(*record);
  }
}

// A frame or a scan begins the poses anew when there were only odometry readings before it and no node.
void EngineFrontEnd::tell(double t) {
  if (only_odometry_ && poses_.empty()) first_t_.reset();
  only_odometry_ = false;
  if (!first_t_) first_t_ = t;
  now_ = now_ ? std::max(*now_, t) : t;
}

void EngineFrontEnd::process(const Scan& scan) {
  if (!setup_->stages.scan_matcher) return;
  if (!advance(last_scan_t_, scan.t)) {
    ++counts_.disordered;
    return;
  }
  ++counts_.scans;
  const ScanMatch matched = front_ends_.match(scan);
  if (!matched.matched)
    ++counts_.scans_unmatched;
  else if (setup_->stages.scan_loop_closer)
    setup_->stages.scan_loop_closer->add(scan, matched);
  tell(scan.t);
}

void EngineFrontEnd::process(const Frame& frame) {
  if (!setup_->stages.rgbd_odometry) return;
  if (!advance(last_frame_t_, frame.t)) {
    ++counts_.disordered;
    return;
  }
  ++counts_.frames;
  if (!front_ends_.track(frame, {}).tracked) ++counts_.frames_lost;
  tell(frame.t);
}

void EngineFrontEnd::process(const Record& record) {
  if (const auto* scan = std::get_if<Scan>(&record)) {
    process(*scan);
  } else if (const auto* frame = std::get_if<Frame>(&record)) {
    process(*frame);
  } else if (const auto* reading = std::get_if<OdometryReading>(&record)) {
    ++counts_.odometry;
    if (!front_ends_.add(*reading)) {
      ++counts_.disordered;
    } else if (only_odometry_) {
      if (!first_t_) first_t_ = reading->t;
      now_ = reading->t;
    }
  }
}

Movement EngineFrontEnd::movementSince(double t, bool planar) const {
  const Motion& motion = front_ends_.motion();
  std::vector<const MotionSource*> sources = {&motion.lidar, &motion.visual, &motion.odometry};
  if (!planar) std::swap(sources[0], sources[1]);
  for (const auto* source : sources)
    if (auto moved = source->between(t, now_.value_or(t), kSilence_s)) return *moved;
  return unknownMovement(now_.value_or(t) - t);
}

Movement EngineFrontEnd::stepSince(double t, bool planar) const {
  const auto moved = front_ends_.motion().odometry.between(t, now_.value_or(t), kSilence_s);
  return moved ? *moved : movementSince(t, planar);
}

std::vector<Movement> EngineFrontEnd::inLocalMapSince(double t) const {
  std::vector<Movement> out;
  for (const auto* source : {&front_ends_.motion().lidar, &front_ends_.motion().visual})
    if (auto moved = source->inLocalMap(t, now_.value_or(t), kSilence_s)) out.push_back(std::move(*moved));
  return out;
}

void EngineFrontEnd::noteNodes(std::size_t count, double t) {
  while (nodes() < count) {
    double own = nodes() == 0 && first_t_ ? std::min(*first_t_, t) : t;
    if (nodes() > 0 && own <= poses_.nodes().back().t)  // two at one time: their order counts
      own = std::nextafter(poses_.nodes().back().t, std::numeric_limits<double>::infinity());
    poses_.add(own, Pose3::Identity());
  }
}

std::vector<BetweenFactor> EngineFrontEnd::betweenNodes(const std::vector<RelativePose>& closures) const {
  std::vector<BetweenFactor> out;
  if (poses_.empty()) return out;
  for (const auto& closure : closures)
    if (const auto factor = closureFactor(closure, poses_, setup_->options.backend.closure_robust_width))
      out.push_back(*factor);
  return out;
}

std::vector<BetweenFactor> EngineFrontEnd::takeScanClosures() {
  if (!setup_->stages.scan_loop_closer || poses_.empty()) return {};
  return betweenNodes(setup_->stages.scan_loop_closer->search([&](double t) { return poses_.between(t); }));
}

std::vector<BetweenFactor> EngineFrontEnd::takeImageClosures() {
  return betweenNodes(front_ends_.takeImageClosures());
}

void EngineFrontEnd::mapObjects(std::unique_ptr<Setup> setup) {
  objects_ = std::make_unique<ObjectFrontEnd>(std::move(setup));
}

std::vector<BetweenFactor> EngineFrontEnd::takeObjectClosures() {
  return objects_ ? betweenNodes(objects_->takeClosures()) : std::vector<BetweenFactor>();
}

std::vector<std::pair<NodeId, SeenObject>> EngineFrontEnd::takeSeenObjects() {
  std::vector<std::pair<NodeId, SeenObject>> out;
  if (!objects_) return out;
  for (auto& [t, object] : objects_->takeSeen()) {
    const KeyPose& node = poses_.nearest(t);
    object.node_from_object = poses_.offset(node, t) * object.node_from_object;
    out.emplace_back(node.id, std::move(object));
  }
  return out;
}

std::set<LandmarkId> EngineFrontEnd::confirmedLandmarks() const {
  return objects_ ? objects_->confirmed() : std::set<LandmarkId>();
}

}  // namespace roomgraph
