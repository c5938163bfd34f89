// SPDX-License-Identifier: BSD-3-Clause
// What the page shows of one run: plain data, gathered from the files of the run.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "roomgraph/evaluation/trajectory_error.h"
#include "roomgraph/report/graph_closures.h"
#include "roomgraph/report/report.h"

namespace roomgraph {

/// Pose of the robot seen from above; t in seconds since the run's first pose.
struct PathPoint {
  double t = 0, x = 0, y = 0, yaw = 0;
};

/// A quantity over time: smallest and largest value in each of equal parts of it; NaN where there is none.
struct BinnedSeries {
  double from = 0, step = 0;
  std::vector<double> low, high;
};

/// Errors of one trajectory against the truth.
struct ReportedErrors {
  TrajectoryErrors figures;
  BinnedSeries position_m, rotation_deg;
  double mean_rotation_deg = 0;
};

struct GridImage {
  std::string png;  ///< grey: 0 occupied, 255 free, 128 unknown; first row = largest y
  int width = 0, height = 0;
  double cell_m = 0, x_min = 0, y_min = 0;
};

/// How an object was seen, of all associations.
struct SightingSummary {
  int count = 0, made_new = 0;
  double first_t = 0, last_t = 0;                      ///< s since the run's first pose
  double mean_probability = 0, least_probability = 1;  ///< of the landmark that was chosen
  int doubtful = 0;                                    ///< sightings whose choice had less than 0.9
  std::vector<std::pair<int, double>> rivals;          ///< other landmarks: summed probability, largest first
  std::vector<int> over_time;                          ///< sightings in equal parts of the run
};

struct ReportedObject {
  int id = -1;
  std::string class_name, model, shape;
  double x = 0, y = 0, z = 0, yaw = 0;
  bool has_yaw = false, in_map = true;
  std::array<double, 3> size{};
  std::vector<std::array<double, 2>> footprint;
  std::array<double, 3> covariance_xy{};  ///< xx, xy, yy, m²
  double z_sigma_m = 0, yaw_sigma_rad = 0;
  double existence = 0;
  std::map<std::string, double> class_posterior, evidence;
  int observations = 0;
  std::optional<SightingSummary> sightings;
  std::string view;  ///< JPEG in Base64; empty: none
};

struct StageRow {
  std::string name;
  int calls = 0;
  double mean_ms = 0, max_ms = 0, total_ms = 0, cpu_ms = 0;
};

struct ConfigRow {
  std::string section, key, value, shipped;
  bool changed = false;
};

struct ReliabilityRow {
  double from = 0, to = 1, mean_probability = 0, correct_share = 0;
  int count = 0;
};

/// A span in which a sensor gave no movement, or no data; s since the run's first pose.
struct LostRow {
  std::string sensor, why;
  double from = 0, to = 0;
  int records = 0;
};

/// What `info` says of the recording.
struct FindingRow {
  std::string severity, place, what, hint;
};

/// Figures that `evaluate --json` left in the folder.
struct EvaluationFile {
  std::string name;
  std::map<std::string, double> figures;
  std::vector<ReliabilityRow> reliability;
};

struct RunData {
  std::string name, recording, version, input, command, interrupted;
  double start_t = 0, duration_s = 0, length_m = 0;
  bool has_poses = false;
  std::vector<PathPoint> path, live_path, truth_path;
  int poses = 0;
  std::vector<std::pair<double, double>> gaps;  ///< spans without a pose, s since the first
  double least_gap_s = 0;                       ///< that counts as one
  BinnedSeries hindsight_m;                     ///< distance between live and final pose
  std::optional<ReportedErrors> final_errors, live_errors;
  bool truth_is_of_camera = false;  ///< errors are those of the camera's path, whose directions are the truth's
  std::optional<GridImage> grid;
  std::vector<ReportedObject> objects;
  std::map<std::string, std::string> colours;  ///< class -> #rrggbb
  std::vector<ClosedLoop> closures;
  std::map<std::string, double> counts, reasons, records_used, records_skipped;
  std::vector<std::string> run_warnings;
  std::vector<StageRow> stages;
  BinnedSeries record_ms;  ///< work on one record, without stages that ran once (at the end)
  double peak_memory_mb = 0;
  double wall_s = 0;  ///< that the run took; 0: it did not say
  std::vector<ConfigRow> config;
  std::vector<EvaluationFile> evaluations;
  std::map<std::string, std::string> missing;  ///< file -> what is wrong with it
  BinnedSeries memory_mb;                      ///< that the program held; empty: the run did not say
  std::optional<std::vector<LostRow>> lost;    ///< nothing: the run did not say
  std::optional<std::vector<FindingRow>> findings;  ///< nothing: the recording was not examined
};

/// Reads all that is there; what is not, or is broken, is named in `missing`.
/// Throws InputError when the folder is none or has no file of a run.
RunData gatherRun(const ReportedRun& run, const ReportRequest& request);

}  // namespace roomgraph
