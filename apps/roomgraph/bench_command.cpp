// SPDX-License-Identifier: BSD-3-Clause
// `roomgraph bench proposals`: cuboid proposals from true or detected boxes, scored against the true objects.
#include <ctime>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "bench_commands.h"
#include "commands.h"
#include "configuration.h"
#include "roomgraph/core/errors.h"
#include "roomgraph/core/output_file.h"
#include "roomgraph/core/progress.h"
#include "roomgraph/datasets/rawlog_reader.h"
#include "roomgraph/evaluation/frame_files.h"
#include "roomgraph/evaluation/object_files.h"
#include "roomgraph/evaluation/report_proposals.h"
#include "roomgraph/evaluation/trajectory_file.h"
#include "roomgraph/pipeline/setup.h"

namespace roomgraph {
namespace {

constexpr double kStampTolerance = 0.02;  // s

struct BenchOptions {
  std::string input, boxes, objects, trajectory, detections, config, json, each;
  std::vector<std::string> overrides;
  double min_visible = 0.6, max_distance_m = 4.5, min_iou = 0.5;
  int every = 1;
};

/// The truth in memory, and which detections go in.
struct BenchInput {
  std::vector<TrueFrame> frames;
  std::vector<EvaluatedObject> objects;
  std::vector<DetectedFrame> detections;
  FramesByTime frames_by_time{frames}, detections_by_time{detections};
  Trajectory world_from_robot;
  std::map<std::string, ClassRule> rules;
};

/// A box that goes in, and the true object behind it.
struct Pairing {
  Detection detection;
  const EvaluatedObject* object = nullptr;
};

BenchInput load(const BenchOptions& options, const ObjectDatabase& database) {
  BenchInput in;
  in.frames = readTrueFrames(options.boxes);
  in.objects = readObjects(options.objects);
  if (!options.detections.empty()) in.detections = readDetections(options.detections);
  in.frames_by_time = FramesByTime(in.frames);
  in.detections_by_time = FramesByTime(in.detections);
  in.world_from_robot = readTrajectory(options.trajectory).trajectory;
  in.rules = classRules(database);
  return in;
}

const EvaluatedObject* objectOf(const TrueBox& box, const BenchInput& in) {
  for (const EvaluatedObject& object : in.objects)
    if (object.id == box.id && in.rules.contains(object.class_name)) return &object;
  return nullptr;
}

// The detector's box of the true one: same class, best IoU.
const DetectedBox* detectionOf(const TrueBox& box, double t, const BenchInput& in, double min_iou) {
  const int frame = in.detections_by_time.nearest(t, kStampTolerance);
  const DetectedBox* best = nullptr;
  if (frame < 0) return nullptr;
  for (const DetectedBox& d : in.detections[frame].boxes)
    if (const double overlap = iou(d.box, box.box); d.class_name == box.class_name && overlap >= min_iou) {
      best = &d;
      min_iou = overlap;
    }
  return best;
}

Pose3 poseOf(const EvaluatedObject& object) {
  return poseFromYpr(object.position.x(), object.position.y(), object.position.z(), object.yaw, 0, 0);
}

std::vector<Pairing> pairingsOf(double t, const Pose3& camera_from_world, const BenchInput& in,
                                const BenchOptions& options) {
  std::vector<Pairing> out;
  const int frame = in.frames_by_time.nearest(t, kStampTolerance);
  if (frame < 0) return out;
  for (const TrueBox& box : in.frames[frame].boxes) {
    const EvaluatedObject* object = objectOf(box, in);
    if (!object || box.visible <= options.min_visible ||
        (camera_from_world * object->position).z() > options.max_distance_m)
      continue;
    const DetectedBox* detected = in.detections.empty() ? nullptr : detectionOf(box, t, in, options.min_iou);
    if (!in.detections.empty() && !detected) continue;
    Detection d;
    d.class_name = d.label = box.class_name;
    d.box = detected ? detected->box : box.box;
    d.score = detected ? detected->score : 1;
    out.push_back({d, object});
  }
  return out;
}

ProposalCase caseOf(int index, const Pairing& pairing, const FrameProposals& made, const BenchInput& in,
                    const Pose3& camera_from_world) {
  ProposalCase c;
  c.class_name = pairing.object->class_name;
  c.rule = in.rules.at(c.class_name);
  c.truth = {c.rule.shape, pairing.object->width, pairing.object->depth, pairing.object->height};
  c.camera_from_truth = camera_from_world * poseOf(*pairing.object);
  if (made.ground) c.camera_from_ground = cameraFromGround(made.ground->plane);
  for (const Proposal& p : made.proposals)
    if (p.detection == index) c.proposals.push_back(p);
  c.t = made.t;
  c.object = pairing.object->id;
  c.box = pairing.detection.box;
  return c;
}

/// What the frames so far have given.
struct BenchRun {
  std::vector<ProposalCase> cases;
  std::vector<GroundCase> grounds;
  std::map<int, std::vector<double>> cpu_ms;
};

void addFrame(const Frame& frame, const Stages& stages, const BenchInput& in,
              const BenchOptions& options, BenchRun& run) {
  const auto world_from_robot = in.world_from_robot.at(frame.t);
  if (!world_from_robot) return;
  const Pose3 world_from_camera = *world_from_robot * frame.robot_from_camera;
  const Pose3 camera_from_world = world_from_camera.inverse();
  const auto pairings = pairingsOf(frame.t, camera_from_world, in, options);
  std::vector<Detection> detections;
  for (const Pairing& p : pairings) detections.push_back(p.detection);
  const std::clock_t start = std::clock();
  const FrameGround ground =
      groundOf(frame, groundInCamera(frame.robot_from_camera), *stages.ground_detector);
  const FrameProposals made = stages.proposal_generator->generate(frame, detections, ground);
  const double ms = 1e3 * static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  run.cpu_ms[static_cast<int>(detections.size())].push_back(ms);
  run.grounds.push_back({groundInCamera(world_from_camera), made.ground});
  for (int i = 0; i < static_cast<int>(pairings.size()); ++i)
    run.cases.push_back(caseOf(i, pairings[i], made, in, camera_from_world));
}

void benchProposals(const BenchOptions& options) {
  Configuration configuration = readConfiguration(options.config, options.overrides);
  for (const char* unused : {"tracking", "lidar", "detection"})
    configuration.config.override(std::string(unused) + ".enabled=false");
  const auto setup = makeSetup(configuration.config, configuration.objects_file);
  const BenchInput in = load(options, setup->database);
  RawlogReader reader(options.input, {true, false, false});
  Progress progress(&std::cerr, "bench", "", 1);
  BenchRun run;
  int index = 0;
  while (const auto record = reader.next()) {
    const Frame* frame = std::get_if<Frame>(&*record);
    if (frame && index++ % options.every == 0)
      addFrame(*frame, setup->stages, in, options, run);
    progress.update(reader.progress(), "");
  }
  progress.finish();
  if (run.grounds.empty()) throw RunError(options.input + ": no frame with a true pose");
  ProposalBenchmark result{evaluateProposals(run.cases), evaluateGround(run.grounds), {}};
  for (auto& [boxes, ms] : run.cpu_ms) result.cpu_ms[boxes] = summarize(std::move(ms));
  std::cout << toTable(result);
  const auto write = [&](const std::string& file, const std::string& text) {
    requireOther(file,
                 {options.input, options.boxes, options.objects, options.trajectory, options.detections});
    writeFileAtomically(file, text);
  };
  if (!options.json.empty()) write(options.json, toJson(result));
  if (options.each.empty()) return;
  std::string lines;
  for (const ProposalCase& c : run.cases) lines += toJsonLine(c);
  write(options.each, lines);
}

void addProposals(CLI::App& parent) {
  auto o = std::make_shared<BenchOptions>();
  auto* command = parent.add_subcommand("proposals", "3D proposals of true or given boxes against the truth");
  command->add_option("INPUT", o->input, "rawlog, plain or gzipped")->required();
  command->add_option("--boxes", o->boxes, "True boxes: boxes.jsonl")->required();
  command->add_option("--objects", o->objects, "True objects: objects.json")->required();
  command->add_option("--trajectory", o->trajectory, "True poses of the robot")->required();
  command->add_option("--detections", o->detections,
                      "Boxes of a detector, detections.jsonl: those of true boxes go in instead");
  command->add_option("--config", o->config, "configuration (default: the installed config.ini)");
  command->add_option("--set", o->overrides, "override: section.key=value; may be repeated");
  command
      ->add_option("--min-visible", o->min_visible, "True boxes that count: with a larger visible share ...")
      ->check(CLI::Range(0.0, 1.0))
      ->capture_default_str();
  command->add_option("--max-distance", o->max_distance_m, "... and nearer, m")
      ->check(aboveZero())
      ->capture_default_str();
  command->add_option("--every", o->every, "Look at every n-th frame")
      ->check(aboveZero())
      ->capture_default_str();
  command->add_option("--json", o->json, "Write the figures here, too");
  command->add_option("--each", o->each,
                      "Write each box, its first proposal and its errors here, as JSON lines");
  command->footer(
      "Example:\n"
      "  roomgraph bench proposals lab_a/lab_a.rawlog --boxes lab_a/boxes.jsonl --objects "
      "lab_a/objects.json \\\n"
      "      --trajectory lab_a/groundtruth_robot.txt --set proposals.use_depth=false \\\n"
      "      --set ground.class=ExpectedGroundDetector");
  command->callback([o] { benchProposals(*o); });
}

}  // namespace

void addBenchCommand(CLI::App& app) {
  auto* command = app.add_subcommand("bench", "Measure single stages against the truth, and the speed of a run");
  command->require_subcommand(1);
  addProposals(*command);
  addSpeedCommand(*command);
}

}  // namespace roomgraph
