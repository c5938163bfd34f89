// SPDX-License-Identifier: BSD-3-Clause
// How fast a run was: time per stage, and latency as if its records had come at their times.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "roomgraph/pipeline/stage_times.h"
#include "roomgraph/pipeline/step_report.h"

namespace roomgraph {

/// Of durations, ms; quantiles by nearest rank.
struct DurationFigures {
  int count = 0;
  double mean_ms = 0, median_ms = 0, p99_ms = 0, max_ms = 0;
};
DurationFigures figuresOf(const std::vector<double>& durations_ms);

/// A stage of a run.
struct StageSpeed {
  std::string stage;
  DurationFigures call;
  double total_ms = 0;  ///< on the wall
  double cpu_ms = 0;    ///< of the threads that called it
};

/// Of each stage, the one that took longest first.
std::vector<StageSpeed> speedOfStages(const StageTimes& times);

/// One server, first come, first served: when what arrives is done.
class WaitingLine {
 public:
  /// Time from the arrival to the end of the work, s; arrivals in order of time.
  double serve(double arrival_s, double work_s);

 private:
  double free_s_ = -std::numeric_limits<double>::infinity();
};

/// Watches a run and tells how late its poses would have been if every record had come at its time: a record
/// waits for those before it. What is done beside the thread of the run (reading, foreseeing) is not in it.
class LatencySink : public Sink {
 public:
  LatencySink() : before_ms_(threadTime_ms()) {}
  void onStep(const StepReport& report) override;
  DurationFigures frames() const { return figuresOf(frames_ms_); }
  DurationFigures scans() const { return figuresOf(scans_ms_); }

 private:
  WaitingLine line_;
  double before_ms_;  ///< processor time of the thread when the last record was done
  std::vector<double> frames_ms_, scans_ms_;
};

/// What `roomgraph bench speed` tells.
struct SpeedReport {
  double recorded_s = 0, wall_s = 0, cpu_s = 0;  ///< of the recording; of the run with its end
  double end_s = 0;                              ///< of wall_s, after the last record
  double peak_memory_mb = 0;
  int threads = 0;  ///< that it may use
  std::vector<StageSpeed> stages;
  DurationFigures frames, scans;  ///< latency

  double timesRealTime() const { return wall_s > 0 ? recorded_s / wall_s : 0; }
  double cores() const { return wall_s > 0 ? cpu_s / wall_s : 0; }
};

std::string toTable(const SpeedReport& report);
std::string toJson(const SpeedReport& report);

}  // namespace roomgraph
