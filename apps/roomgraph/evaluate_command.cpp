// SPDX-License-Identifier: BSD-3-Clause
// `roomgraph evaluate`: trajectory, relations, objects, detections and map against truth, as table and JSON.
#include <filesystem>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "commands.h"
#include "roomgraph/core/errors.h"
#include "roomgraph/core/output_file.h"
#include "roomgraph/evaluation/association_error.h"
#include "roomgraph/evaluation/detection_error.h"
#include "roomgraph/evaluation/map_error.h"
#include "roomgraph/evaluation/object_error.h"
#include "roomgraph/evaluation/relations.h"
#include "roomgraph/evaluation/report.h"
#include "roomgraph/evaluation/trajectory_error.h"
#include "roomgraph/evaluation/trajectory_file.h"
#include "roomgraph/mapping/map_files.h"
#include "shared_files.h"

namespace roomgraph {
namespace {

TrajectoryFile readAndWarn(const std::string& file) {
  TrajectoryFile read = readTrajectory(file);
  if (!read.sorted) std::cerr << file << ": stamps are out of order, sorted\n";
  if (read.duplicates > 0)
    std::cerr << file << ": " << read.duplicates << " poses with a repeated stamp dropped\n";
  return read;
}

template <class... Errors>
void report(const std::string& json_file, const std::vector<std::filesystem::path>& inputs,
            const Errors&... errors) {
  (std::cout << ... << toTable(errors));
  if (json_file.empty()) return;
  requireOther(json_file, inputs);
  writeFileAtomically(json_file, toJson(errors...));
}

struct PathArguments {
  std::string truth, estimate;
};

// Options that bring a map into the world of the truth by the trajectories of both.
void addPaths(CLI::App& command, PathArguments& paths) {
  auto* truth = command.add_option("--truth-trajectory", paths.truth, "Align by trajectories: truth");
  auto* estimate = command.add_option("--trajectory", paths.estimate, "Align by trajectories: the map's");
  truth->needs(estimate);
  estimate->needs(truth);
}

constexpr double kLever_m = 0.1;  // of a robot that turns on the spot positions tell no yaw

Pose2 truthFromMap(const PathArguments& paths) {
  if (paths.estimate.empty()) return {};
  TrajectoryOptions association;
  association.interpolate_truth = true;
  const auto pairs =
      associate(readAndWarn(paths.truth).trajectory, readAndWarn(paths.estimate).trajectory, association);
  if (pairs.empty()) throw RunError(paths.estimate + " has no pose within the time of " + paths.truth);
  return alignPlanar(pairs, kLever_m);
}

void addTrajectory(CLI::App& parent) {
  struct Arguments {
    std::string truth, estimate, json;
    TrajectoryOptions options;
    bool unaligned = false;
  };
  auto* command = parent.add_subcommand("trajectory", "ATE after SE(3) alignment (no scale), RPE, coverage");
  auto a = std::make_shared<Arguments>();
  command->add_option("truth", a->truth, "True poses: t tx ty tz qx qy qz qw, or t x y yaw")->required();
  command->add_option("estimate", a->estimate, "Estimated poses, the same formats")->required();
  command->add_option("--json", a->json, "Write the figures here, too");
  command
      ->add_option("--max-difference", a->options.max_difference_s, "Largest difference of paired stamps, s")
      ->check(atLeastZero())
      ->capture_default_str();
  command->add_flag("--interpolate", a->options.interpolate_truth,
                    "Interpolate the truth at the estimate's stamps");
  command->add_flag("--no-align", a->unaligned, "Compare as they are");
  auto* seconds =
      command->add_option("--delta", a->options.rpe_delta_s, "Time between the poses of a relative error, s")
          ->check(aboveZero())
          ->capture_default_str();
  command->add_option("--delta-frames", a->options.rpe_delta_frames, "That many pairs instead of seconds")
      ->check(aboveZero())
      ->excludes(seconds);
  command->footer(
      "Example:\n  roomgraph evaluate trajectory groundtruth.txt OUT/trajectory_camera.tum --json ate.json");
  command->callback([a] {
    a->options.align = !a->unaligned;
    const auto truth = readAndWarn(a->truth), estimate = readAndWarn(a->estimate);
    const auto errors = evaluateTrajectory(truth.trajectory, estimate.trajectory, a->options);
    report(a->json, {a->truth, a->estimate}, errors);
    if (errors.pairs == 0)
      throw RunError("no stamp of " + a->estimate + " is within " +
                     std::to_string(a->options.max_difference_s) + " s of one in " + a->truth);
  });
}

void addRelations(CLI::App& parent) {
  struct Arguments {
    std::string relations, estimate, json;
    RelationOptions options;
  };
  auto* command = parent.add_subcommand("relations", "Verified relative poses (Kuemmerle et al. 2009)");
  auto a = std::make_shared<Arguments>();
  command->add_option("relations", a->relations, "Lines t1 t2 x y z roll pitch yaw")->required();
  command->add_option("estimate", a->estimate, "Estimated robot poses, TUM format or t x y yaw")->required();
  command->add_option("--json", a->json, "Write the figures here, too");
  command->footer(
      "Example:\n  roomgraph evaluate relations intel.relations OUT/trajectory.tum --json relations.json");
  command->callback([a] {
    const auto relations = readRelations(a->relations);
    const auto errors = evaluateRelations(relations, readAndWarn(a->estimate).trajectory, a->options);
    report(a->json, {a->relations, a->estimate}, errors);
    if (errors.used == 0)
      throw RunError(a->estimate + " has poses for none of the relations in " + a->relations);
  });
}

struct ObjectArguments {
  std::string truth, landmarks, json, boxes, associations, database;
  PathArguments paths;
  ObjectOptions options;
  AssociationOptions association;
  VisibilityRule rule;
};

void runObjects(ObjectArguments& a) {
  const auto truth = readObjects(a.truth), landmarks = readObjects(a.landmarks);
  a.options.classes = classRules(ObjectDatabase::fromFile(objectsFileOf(a.landmarks, a.database)));
  if (!a.boxes.empty()) a.options.seen = readSeenObjects(a.boxes, a.rule);
  a.options.truth_from_map = truthFromMap(a.paths);
  const auto errors = evaluateObjects(truth, landmarks, a.options);
  const std::vector<std::filesystem::path> inputs{a.truth, a.landmarks, a.boxes, a.associations, a.database, a.paths.truth, a.paths.estimate};
  if (a.associations.empty()) {
    report(a.json, inputs, errors);
  } else {
    report(a.json, inputs, errors,
           evaluateAssociations(readTrueFrames(a.boxes), readAssociations(a.associations), a.association));
  }
}

void addObjects(CLI::App& parent) {
  auto* command = parent.add_subcommand("objects", "Landmarks against true objects");
  auto a = std::make_shared<ObjectArguments>();
  command->add_option("truth", a->truth, "True objects: objects.json")->required();
  command->add_option("landmarks", a->landmarks, "Mapped objects: landmarks.json")->required();
  command->add_option("--json", a->json, "Write the figures here, too");
  command->add_option("--gate", a->options.gate_m, "Largest distance of the centres on the ground, m")
      ->check(aboveZero())
      ->capture_default_str();
  command->add_option("--min-existence", a->options.min_existence, "Skip landmarks that are less probable")
      ->check(CLI::Range(0.0, 1.0))
      ->capture_default_str();
  command->add_option("--database", a->database,
                      "Shape and yaw symmetry of each class (default: objects.ini beside the landmarks, else "
                      "the shipped one)");
  auto* boxes = command->add_option("--truth-boxes", a->boxes,
                                    "boxes.jsonl: only objects really seen count for recall");
  command->add_option("--min-frames", a->rule.min_frames, "Seen: in so many frames")
      ->needs(boxes)
      ->capture_default_str();
  command->add_option("--min-visible", a->rule.min_visible, "... with a larger visible share")
      ->needs(boxes)
      ->capture_default_str();
  command->add_option("--min-height-px", a->rule.min_height_px, "... a higher box, px")
      ->needs(boxes)
      ->capture_default_str();
  command->add_option("--max-depth", a->rule.max_depth_m, "... and nearer, m")
      ->needs(boxes)
      ->capture_default_str();
  command
      ->add_option("--associations", a->associations,
                   "associations.jsonl: also judges each decision of the data association")
      ->needs(boxes);
  command->add_option("--min-iou", a->association.min_iou, "Of a measurement and the true box it belongs to")
      ->needs("--associations")
      ->check(CLI::Range(0.0, 1.0))
      ->capture_default_str();
  addPaths(*command, a->paths);
  command->footer(
      "Example:\n  roomgraph evaluate objects lab_a/objects.json OUT/landmarks.json \\\n"
      "      --truth-boxes lab_a/boxes.jsonl --associations OUT/associations.jsonl --json "
      "objects_score.json");
  command->callback([a] { runObjects(*a); });
}

void addDetections(CLI::App& parent) {
  struct Arguments {
    std::string truth, detections, json;
    DetectionOptions options;
  };
  auto* command = parent.add_subcommand("detections", "Detected against true boxes: precision, recall, AP");
  auto a = std::make_shared<Arguments>();
  command->add_option("truth", a->truth, "True boxes: boxes.jsonl")->required();
  command->add_option("detections", a->detections, "Detected boxes: detections.jsonl")->required();
  command->add_option("--json", a->json, "Write the figures here, too");
  command->add_option("--iou", a->options.min_iou, "Least IoU of a detection and the true box it finds")
      ->check(CLI::Range(0.01, 1.0))
      ->capture_default_str();
  command->add_option("--min-score", a->options.min_score, "Weaker detections are not looked at")
      ->check(CLI::Range(0.0, 1.0))
      ->capture_default_str();
  command
      ->add_option("--min-visible", a->options.min_visible,
                   "True boxes that count: with a larger visible share ...")
      ->check(CLI::Range(0.0, 1.0))
      ->capture_default_str();
  command->add_option("--min-height-px", a->options.min_height_px, "... and higher, px")
      ->check(atLeastZero())
      ->capture_default_str();
  command
      ->add_option("--max-difference", a->options.max_difference_s, "Largest difference of paired stamps, s")
      ->check(atLeastZero())
      ->capture_default_str();
  command->footer(
      "Example:\n  roomgraph evaluate detections lab_a/boxes.jsonl OUT/detections.jsonl --iou 0.5");
  command->callback([a] {
    const auto errors =
        evaluateDetections(readTrueFrames(a->truth), readDetections(a->detections), a->options);
    report(a->json, {a->truth, a->detections}, errors);
    if (errors.frames == 0) throw RunError(a->detections + " has no frame in common with " + a->truth);
  });
}

void addMap(CLI::App& parent) {
  struct Arguments {
    std::string truth, map, json;
    PathArguments paths;
    MapOptions options;
  };
  auto* command = parent.add_subcommand("map", "Occupancy map: agreement, distance of the walls");
  auto a = std::make_shared<Arguments>();
  command->add_option("truth", a->truth, "True map: map_truth.yaml")->required();
  command->add_option("map", a->map, "Estimated map: map.yaml")->required();
  command->add_option("--json", a->json, "Write the figures here, too");
  command
      ->add_option("--tolerance", a->options.tolerance_cells,
                   "How far an occupied cell may be from one of the other map, cells")
      ->check(atLeastZero())
      ->capture_default_str();
  addPaths(*command, a->paths);
  command->footer(
      "Example:\n  roomgraph evaluate map lab_a/map_truth.yaml OUT/map.yaml --json map_score.json");
  command->callback([a] {
    const auto truth = loadOccupancyRos(a->truth), map = loadOccupancyRos(a->map);
    // Between the grids' own corners.
    const Pose2 truth_from_corner{truth.origin.x(), truth.origin.y(), 0}, map_from_corner{map.origin.x(), map.origin.y(), 0};
    a->options.truth_from_map = truth_from_corner.inverse() * truthFromMap(a->paths) * map_from_corner;
    const auto errors = evaluateMap(truth.grid, map.grid, a->options);
    report(a->json, {a->truth, a->map, a->paths.truth, a->paths.estimate}, errors);
    if (errors.known_in_both == 0) throw RunError(a->map + " knows no place that " + a->truth + " knows");
  });
}

}  // namespace

void addEvaluateCommand(CLI::App& app) {
  auto* command = app.add_subcommand("evaluate", "Compare results with the truth");
  command->require_subcommand(1);
  command->footer(
      "Examples:\n"
      "  roomgraph evaluate trajectory groundtruth.txt OUT/trajectory_camera.tum\n"
      "  roomgraph evaluate relations intel.relations OUT/trajectory.tum --json relations.json\n"
      "  roomgraph evaluate objects objects.json OUT/landmarks.json --truth-boxes boxes.jsonl\n"
      "  roomgraph evaluate detections boxes.jsonl OUT/detections.jsonl\n"
      "  roomgraph evaluate map map_truth.yaml OUT/map.yaml");
  addTrajectory(*command);
  addRelations(*command);
  addObjects(*command);
  addDetections(*command);
  addMap(*command);
}

}  // namespace roomgraph
