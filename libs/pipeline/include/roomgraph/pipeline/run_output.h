// SPDX-License-Identifier: BSD-3-Clause
// Result files of a run, written live or at the end.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "roomgraph/core/output_file.h"
#include "roomgraph/core/output_folder.h"
#include "roomgraph/datasets/rawlog_reader.h"
#include "roomgraph/datasets/rawlog_report.h"
#include "roomgraph/pipeline/best_views.h"
#include "roomgraph/pipeline/clock_settings.h"
#include "roomgraph/pipeline/lost_spans.h"
#include "roomgraph/pipeline/mount_settings.h"
#include "roomgraph/pipeline/replay.h"
#include "roomgraph/pipeline/semantic_slam.h"

namespace roomgraph {

/// Where a run comes from.
struct RunOrigin {
  std::string input;                 ///< the recording
  std::string version, revision;     ///< of the program
  std::vector<std::string> command;  ///< the words of the command line
  std::vector<std::string> networks = {};  ///< of the model folder, chosen because nothing else gave boxes
  std::optional<std::vector<Finding>> findings = {};  ///< about the recording; nothing: not examined
  std::vector<ClockSetting> clocks = {};  ///< of sensors, that were set
  std::vector<MountSetting> mounts = {};  ///< poses of sensors, that were set
  bool resumed = false;  ///< what an interrupted run had computed was recalled: timings are without it
  double wall_s = 0;     ///< that the run took until these files are written, by the clock; 0: not known
};

/// Writes a run's files (docs/formats.md). What is known live goes to disk as it comes, the rest at the end.
/// They get into their places by files().publish(). Throws RunError naming the file when one cannot be
/// written.
class RunOutput : public Sink {
 public:
  /// Makes and locks the folder. Throws ConfigError when one of the inputs would be replaced.
  RunOutput(const std::filesystem::path& folder, const std::vector<std::filesystem::path>& inputs);

  void onStep(const StepReport& report) override;

  /// Final files: trajectories, landmarks, occupancy, map, graph, effective config, summary.
  void writeResult(const SemanticSlam& slam, const SlamResult& result, const ReadStatistics& read,
                   const ReplayState& replayed, const RunOrigin& origin);

  /// `snapshot.png` is theirs, too.
  OutputFolder& files() { return files_; }

 private:
  void write(const std::string& name, const std::string& text) const;
  void stream(const std::string& name, const std::function<void(std::ostream&)>& text) const;

  OutputFolder files_;
  BestViews views_;
  LostSpans lost_;
  OutputFile live_, detections_, associations_;
};

/// "t tx ty tz qx qy qz qw" lines.
void writeTum(std::ostream& out, const std::vector<StampedPose>& poses);

}  // namespace roomgraph
