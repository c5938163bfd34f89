// SPDX-License-Identifier: BSD-3-Clause
// From a planned run to a task: what is known of it, whether it has to be done, and how.
#pragma once

#include <optional>

#include "file_hashes.h"
#include "roomgraph/batch/batch.h"
#include "roomgraph/batch/run_task.h"

namespace roomgraph {

/// On a network file system, files that others made are seen when their folder is opened anew.
inline void lookInto(const std::filesystem::path& folder) {
  std::error_code none;
  std::filesystem::directory_iterator(folder, none);
}

/// A run that can be started.
struct PreparedRun {
  RunTask task;
  bool needed = true;                ///< false: it is complete and unchanged
  std::string why;                   ///< it is done, in words ("new")
  std::filesystem::path detections;  ///< where its detections are shared; empty: nowhere
};

/// Knows the folder, the program and what was run before.
class RunPreparer {
 public:
  /// All outlive it.
  RunPreparer(const BatchPlan& plan, std::filesystem::path folder, const BatchProgram& program,
              RunInspector& inspector, FileHashes& hashes);

  /// The recording of an input: the named one, or the one in the folder of a simulated input. Throws
  /// InputError: there is none.
  std::filesystem::path recordingOf(std::size_t input) const;
  /// Whether a simulated input has been made already, as it would be made now.
  bool isReady(std::size_t input) const;
  /// To be called when it has been made, or is about to be.
  void markReady(std::size_t input, bool ready) const;

  /// Where the measure of a recording is remembered, and what it says.
  std::filesystem::path measureFileOf(std::size_t input) const {
    return folder_ / "inputs" / (plan_.inputs[input].input.name + ".measure");
  }
  std::optional<RecordingMeasure> measureOf(std::size_t input) const {
    lookInto(folder_ / "inputs");
    return readMeasure(measureFileOf(input), recordingOf(input));
  }

  /// Of a run that is joined from pieces: once they are complete. Throws Error: what cannot be run.
  PreparedRun prepare(std::size_t run) const;
  /// Throws RunError: the program is not the one any more with which the batch began.
  void requireSameProgram() const;
  /// What is known of a run before its input is looked at.
  RunResult planned(std::size_t run) const;
  std::filesystem::path folderOf(std::size_t run) const { return folder_ / "runs" / plan_.runs[run].name; }
  std::filesystem::path folderOfInput(std::size_t input) const {
    return folder_ / "inputs" / plan_.inputs[input].input.name;
  }

  /// Lets a task compute (record) or take (replay) shared detections.
  static void shareDetections(PreparedRun& run, bool replay);

 private:
  void decide(PreparedRun& run) const;
  std::vector<std::string> runWords(std::size_t run, const std::filesystem::path& rawlog) const;
  std::vector<std::string> joinWords(const PlannedRun& run, const std::filesystem::path& folder) const;
  void fillIn(const PlannedRun& run, const RunNeeds& needs, PreparedRun& out) const;

  const BatchPlan& plan_;
  std::filesystem::path folder_;
  const BatchProgram& program_;
  RunInspector& inspector_;
  FileHashes& hashes_;
  std::string program_hash_, simulator_hash_;
};

/// The result in a run's folder; nothing: there is none that can be read.
std::optional<RunResult> resultIn(const std::filesystem::path& folder);

/// Throws RunError.
void makeFolder(const std::filesystem::path& folder);

}  // namespace roomgraph
