// SPDX-License-Identifier: BSD-3-Clause
// A batch carried out: what is to be done is found out, done, and put into the catalogue.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <ostream>
#include <string>
#include <vector>

#include "roomgraph/batch/engine.h"
#include "roomgraph/batch/plan.h"

namespace roomgraph {

/// What decides the outcome of `roomgraph run` besides the recording's bytes.
struct RunNeeds {
  std::map<std::string, std::string> parameters;  ///< "section.key" of the effective configuration
  std::string objects;                            ///< text of the object database
  std::vector<std::filesystem::path> files;       ///< networks, boxes, plug-ins: their bytes count
  /// Everything that the detections depend on besides the recording and those files, as text; empty: no
  /// network runs, or its detections cannot be replayed.
  std::string detections;
};

/// The program, which knows its configuration; the batch does not.
class RunInspector {
 public:
  virtual ~RunInspector() = default;
  /// Throws Error: the configuration is wrong, or the recording cannot be read.
  virtual RunNeeds needsOf(const BatchVariant& variant, const std::filesystem::path& rawlog) = 0;
};

/// The program that runs.
struct BatchProgram {
  std::filesystem::path file;  ///< its executable
  std::string version, revision;
  std::vector<std::filesystem::path> parts;      ///< it and its libraries: their bytes count
  std::vector<std::filesystem::path> simulator;  ///< those on which simulated recordings depend
};

/// Progress for people.
struct BatchView {
  std::ostream* out = nullptr;  ///< nothing: silent
  bool terminal = false;        ///< one display that is drawn anew; else a line for each event
};

/// How a batch went.
struct BatchOutcome {
  std::size_t done = 0, failed = 0, skipped = 0, left = 0;  ///< runs; left: not begun, or interrupted
  double wall_s = 0, run_s = 0;                             ///< of all; sum over the runs that were done
  bool interrupted = false;
  std::vector<std::string> problems;     ///< of runs that failed, one line each
  std::vector<std::string> unevaluated;  ///< runs done of which an evaluation failed, one line each
};

/// Lock of a batch folder, held while it exists. Throws RunError: another process has it, or no folder can be
/// made.
class BatchLock {
 public:
  explicit BatchLock(const std::filesystem::path& folder);
  ~BatchLock();
  BatchLock(const BatchLock&) = delete;
  BatchLock& operator=(const BatchLock&) = delete;

 private:
  int descriptor_ = -1;
};

/// Carries the plan out in `folder`: inputs are simulated, runs done that are not complete or not the same
/// any more, detections shared, results put into FOLDER/catalogue.sqlite. `lock`: of the folder.
/// Throws RunError: the folder cannot be written, or the engine starts nothing; ConfigError: a variant is
/// wrong.
BatchOutcome runBatch(const BatchPlan& plan, const std::filesystem::path& folder, const BatchProgram& program,
                      RunInspector& inspector, Engine& engine, const BatchView& view,
                      const std::function<bool()>& interrupted, const BatchLock& lock);

/// What runBatch() would do.
struct PlanInWords {
  std::string text;        ///< lines
  std::size_t needed = 0;  ///< runs to do
  double memory_mb = 0;    ///< that one of them is expected to need, at most
};

/// Simulates and runs nothing.
PlanInWords describePlan(const BatchPlan& plan, const std::filesystem::path& folder,
                         const BatchProgram& program, RunInspector& inspector);

}  // namespace roomgraph
