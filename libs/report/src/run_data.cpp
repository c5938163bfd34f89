// SPDX-License-Identifier: BSD-3-Clause
// Gathering of a run's files; each on its own, so that a broken one costs its section only.
#include "run_data.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>

#include "config_file.h"
#include "grid_image.h"
#include "lost_list.h"
#include "object_list.h"
#include "path_thinning.h"
#include "pose_curves.h"
#include "roomgraph/core/error_text.h"
#include "roomgraph/core/errors.h"
#include "roomgraph/core/json_integer.h"
#include "roomgraph/evaluation/trajectory_file.h"
#include "roomgraph/report/graph_closures.h"
#include "sightings.h"
#include "stage_table.h"

namespace roomgraph {
namespace {

constexpr std::array kFilesOfARun{"summary.json", "trajectory.tum", "landmarks.json", "map.yaml"};
constexpr std::size_t kMostPoints = 6000, kMostViewBytes = 4 << 20;

void requireRun(const std::filesystem::path& folder) {
  std::error_code none;
  if (!std::filesystem::is_directory(folder, none))
    throw InputError(folder.string() + ": is no folder of a run");
  if (std::none_of(kFilesOfARun.begin(), kFilesOfARun.end(),
                   [&](const char* name) { return std::filesystem::exists(folder / name, none); }))
    throw InputError(folder.string() +
                     ": has no file of a run (summary.json, trajectory.tum, landmarks.json, …)");
}

// Messages name the whole path of a file; beside its name that is noise.
std::string withoutFolder(std::string message, const std::filesystem::path& file) {
  const std::string prefix = file.string() + ":";
  if (message.starts_with(prefix)) message.erase(0, prefix.size());
  return message.substr(std::min(message.find_first_not_of(' '), message.size()));
}

class Gathering {
 public:
  Gathering(std::filesystem::path folder, RunData& run) : folder_(std::move(folder)), run_(run) {}

  const std::filesystem::path& folder() const { return folder_; }
  // Reads one file; what is wrong with it is noted.
  void read(const std::string& name, const std::function<void(const std::filesystem::path&)>& reader) {
    const auto file = folder_ / name;
    std::error_code none;
    if (!std::filesystem::exists(file, none)) {
      run_.missing[name] = "is not there";
      return;
    }
    try {
      reader(file);
    } catch (const std::exception& error) {
      run_.missing[name] = withoutFolder(firstLine(error), file);
    }
  }
  void readLines(const std::string& name, const std::function<void(std::istream&)>& reader) {
    read(name, [&](const std::filesystem::path& file) {
      std::ifstream in(file, std::ios::binary);
      if (!in || std::filesystem::is_directory(file)) throw InputError("cannot be opened");
      reader(in);
    });
  }

 private:
  std::filesystem::path folder_;
  RunData& run_;
};

std::vector<PathPoint> thinPath(const std::vector<PathPoint>& path) {
  return thinned(path, kMostPoints, longestSpacing(path));
}

struct Trajectories {
  Trajectory live, final;  // of the robot
  Trajectory camera;       // final, optical frame
};

Trajectories gatherPaths(Gathering& files, RunData& run) {
  Trajectories out;
  files.read("trajectory.tum", [&](const auto& file) { out.final = readTrajectory(file).trajectory; });
  files.read("live.tum", [&](const auto& file) { out.live = readTrajectory(file).trajectory; });
  // It holds no pose where there was no camera.
  if (std::error_code none; std::filesystem::file_size(files.folder() / "trajectory_camera.tum", none) > 0 && !none)
    files.read("trajectory_camera.tum", [&](const auto& file) { out.camera = readTrajectory(file).trajectory; });
  const Trajectory& longest = out.final.empty() ? out.live : out.final;
  if (longest.empty()) return out;
  run.start_t = longest.firstTime();
  run.duration_s = longest.lastTime() - run.start_t;
  run.has_poses = !out.final.empty();
  run.poses = static_cast<int>(out.final.size());
  const auto path = seenFromAbove(out.final, run.start_t);
  run.path = thinPath(path);
  run.length_m = lengthOf(path);
  run.gaps = gapsOf(path);
  run.least_gap_s = longestSpacing(path);
  run.live_path = thinPath(seenFromAbove(out.live, run.start_t));
  run.hindsight_m = hindsightOf(out.live, out.final, run.start_t, run.duration_s);
  return out;
}

// Of the camera, as it is on the robot where both are known first.
Trajectory seenByCamera(const Trajectory& robot, const Trajectories& known) {
  std::optional<Pose3> robot_from_camera;
  for (const auto& camera : known.camera.poses())
    if (const auto at = known.final.at(camera.t); at && !robot_from_camera) robot_from_camera = at->inverse() * camera.pose;
  Trajectory out;
  if (robot_from_camera)
    for (const auto& pose : robot.poses()) out.add(pose.t, pose.pose * *robot_from_camera);
  return out;
}

constexpr double kClearlyFits = 0.5;  // of the error in direction of the other path

// True paths are those of the robot or, as importers of handheld recordings write them, of the camera: directions tell.
void compareWithTruth(const std::filesystem::path& file, const Trajectories& estimated, RunData& run) {
  const Trajectory truth = readTrajectory(file).trajectory;
  const auto errors = [&](const Trajectory& path) { return errorsOf(truth, path, run.start_t, run.duration_s); };
  run.final_errors = errors(estimated.final);
  run.live_errors = errors(estimated.live);
  const auto of_camera = errors(seenByCamera(estimated.final, estimated));
  if (of_camera && run.final_errors && of_camera->mean_rotation_deg < kClearlyFits * run.final_errors->mean_rotation_deg) {
    run.truth_is_of_camera = true;
    run.final_errors = of_camera;
    run.live_errors = errors(seenByCamera(estimated.live, estimated));
  }
  if (!run.final_errors) return;
  const Pose3 estimate_from_truth = run.final_errors->figures.truth_from_estimate.inverse();
  Trajectory moved;
  for (const auto& pose : truth.poses()) moved.add(pose.t, estimate_from_truth * pose.pose);
  run.truth_path = thinPath(seenFromAbove(moved, run.start_t));
}

void gatherObjects(Gathering& files, RunData& run) {
  ObjectFile mapped, candidates;
  files.read("landmarks.json", [&](const auto& file) { mapped = readObjectFile(file); });
  files.read("candidates.json", [&](const auto& file) { candidates = readObjectFile(file); });
  run.recording = mapped.recording;
  run.objects = merged(std::move(mapped.objects), std::move(candidates.objects));
  files.read("objects.ini", [&](const auto& file) { run.colours = readColours(file); });
  files.readLines("associations.jsonl", [&](std::istream& lines) {
    const auto sightings = readSightings(lines, "associations.jsonl", run.start_t, run.duration_s);
    for (auto& object : run.objects)
      if (const auto of = sightings.find(object.id); of != sightings.end()) object.sightings = of->second;
  });
}

bool isBase64(const std::string& text) {
  return !text.empty() && text.size() % 4 == 0 && std::all_of(text.begin(), text.end(), [](unsigned char c) {
    return std::isalnum(c) || c == '+' || c == '/' || c == '=';
  });
}

// One line per landmark; those of landmarks that are not in the map are passed over.
void readViews(std::istream& lines, RunData& run) {
  std::size_t bytes = 0;
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    const auto view = nlohmann::json::parse(line, nullptr, false);
    const auto id = view.is_object() ? view.find("id") : view.end();
    const auto jpeg = view.is_object() ? view.find("jpeg") : view.end();
    if (!view.is_object() || id == view.end() || !id->is_number_integer() || jpeg == view.end() ||
        !jpeg->is_string() || !isBase64(jpeg->get<std::string>()))
      throw InputError("views.jsonl:" + std::to_string(number) + ": is no view of a landmark");
    bytes += line.size();
    if (bytes > kMostViewBytes) return;
    for (auto& object : run.objects)
      if (object.id == integerOf<std::int64_t>(*id)) object.view = jpeg->get<std::string>();
  }
}

// Runs of earlier versions have none: nothing is missing without them.
void gatherNewerFiles(const std::filesystem::path& folder, Gathering& files, RunData& run) {
  std::error_code none;
  if (std::filesystem::exists(folder / "views.jsonl", none))
    files.readLines("views.jsonl", [&](std::istream& lines) { readViews(lines, run); });
  if (std::filesystem::exists(folder / "lost.jsonl", none))
    files.readLines("lost.jsonl", [&](std::istream& lines) { run.lost = readLost(lines, run.start_t); });
}

}  // namespace

RunData gatherRun(const ReportedRun& asked, const ReportRequest& request) {
  requireRun(asked.folder);
  RunData run;
  run.name = asked.name;
  Gathering files(asked.folder, run);
  const Trajectories estimated = gatherPaths(files, run);
  if (!request.truth.empty()) compareWithTruth(request.truth, estimated, run);
  files.read("summary.json", [&](const auto& file) { readSummary(file, run); });
  files.readLines("timings.csv", [&](std::istream& lines) { readTimings(lines, "timings.csv", run); });
  gatherObjects(files, run);
  gatherNewerFiles(asked.folder, files, run);
  files.read("map.yaml", [&](const auto& file) { run.grid = readGridImage(file); });
  files.readLines("graph.g2o", [&](std::istream& graph) { run.closures = readClosures(graph, run.start_t); });
  files.read("config.ini", [&](const auto& file) { run.config = readConfigRows(file, request.defaults); });
  run.evaluations = readEvaluations(asked.folder);
  return run;
}

}  // namespace roomgraph
