// SPDX-License-Identifier: BSD-3-Clause
// The checkpoint of a run: what it belongs to, and the results that need not be computed again.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "roomgraph/core/output_folder.h"
#include "roomgraph/core/result_store.h"
#include "run_beginnings.h"
#include "run_identity.h"
#include "run_options.h"

namespace roomgraph {

/// What a run was begun with.
struct RunBegun {
  std::vector<std::string> command;  ///< words of the command line
  RunIdentity identity;
  RunBeginnings beginnings;
};

/// The folder OUT/roomgraph_checkpoint (docs/formats.md) while a run goes on. It vanishes when the run
/// publishes its files; what is left of a run that ended otherwise is for `--resume`.
class RunCheckpoint {
 public:
  /// Begins a checkpoint, in place of any other, or with `resume` goes on with the one that is there. Throws
  /// ConfigError: that one is of another run; RunError: cannot be written.
  RunCheckpoint(const OutputFolder& files, const RunBegun& run, double sync_s, bool resume);
  /// Removes a checkpoint without results: it would save nothing.
  ~RunCheckpoint();
  RunCheckpoint(const RunCheckpoint&) = delete;
  RunCheckpoint& operator=(const RunCheckpoint&) = delete;

  /// Removes it: the run would fail again.
  void discard() const;

  JournalledResults& results() { return *results_; }
  /// The words of the command line with which the run was begun.
  const std::vector<std::string>& command() const { return command_; }
  /// How much there is to go on with, in a line; empty for a run that begins.
  std::string whatIsThere() const;

 private:
  void begin(const RunBegun& run) const;

  std::filesystem::path folder_;
  std::vector<std::string> command_;
  std::unique_ptr<JournalledResults> results_;
};

/// Of the unfinished run in an output folder; the first one without a checkpoint. Throws InputError: cannot be read.
RunBeginnings beginningsOfCheckpoint(const std::filesystem::path& output);

/// For `--resume`: what was asked for when the run was begun, with what is said now besides; the working
/// directory becomes that of then. Nothing, after a line on standard output, when the run is complete. Throws
/// InputError: no checkpoint; RunError: another process uses the folder.
std::optional<RunOptions> optionsToResume(const RunOptions& now);

}  // namespace roomgraph
