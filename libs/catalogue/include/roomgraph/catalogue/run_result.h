// SPDX-License-Identifier: BSD-3-Clause
// RunResult: what a run of a batch says of itself in its result.json.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace roomgraph {

/// Ends the name of a variant whose runs are pieces of recordings, from which those of the variant are joined.
inline constexpr std::string_view kPieceSuffix = ".piece";

/// The recording of a run.
struct RunInput {
  std::string name;   ///< unique in a batch
  std::string group;  ///< inputs that differ only in their seed are of one group
  std::optional<std::int64_t> seed;
  std::string path, sha256;
  std::int64_t bytes = 0;
};

/// An attempt that gave no result.
struct FailedAttempt {
  std::string started;  ///< UTC, ISO 8601
  int exit_code = 0;    ///< 128 + n: ended by signal n
  std::string reason;
  double wall_s = 0;
};

/// All calls of one stage.
struct StageTotal {
  std::int64_t calls = 0;
  double total_ms = 0, max_ms = 0;
};

/// What was run, and what came of it. A folder without one holds no whole run.
struct RunResult {
  std::string name, variant;
  std::string status;  ///< complete, failed or interrupted
  std::string reason;  ///< of what is not complete, one line
  RunInput input;
  std::string key;             ///< of all that decides what comes out of `run`
  std::string evaluation_key;  ///< of the truth and what is done with it
  std::string version, revision, program;
  std::map<std::string, std::string> parameters;  ///< "section.key" of the effective configuration
  std::vector<std::string> command;
  int exit_code = 0;
  std::string started;  ///< UTC, ISO 8601
  double wall_s = 0, cpu_s = 0, peak_memory_mb = 0;
  std::map<std::string, double> figures;  ///< "trajectory.ate_rmse_m"
  std::map<std::string, StageTotal> timings;
  std::vector<FailedAttempt> failures;
  std::map<std::string, std::int64_t> files;  ///< that it left, bytes
  std::string keep;                           ///< summary, map or all

  bool complete() const { return status == "complete"; }
};

/// Throws InputError naming file and cause.
RunResult readRunResult(const std::filesystem::path& file);

/// Written to the disk, then renamed: the last thing that a run does. Throws RunError.
void writeRunResult(const RunResult& result, const std::filesystem::path& file);

/// The text of such a file, and back. `name`: of the text, for messages. Throws InputError.
std::string textOfRunResult(const RunResult& result);
RunResult runResultOfText(const std::string& text, const std::string& name);

/// Every number of a report by its place in it ("per_class.sofa.correct"), behind `prefix` and a dot. Lists
/// are left out. Throws InputError: not readable, or no JSON.
std::map<std::string, double> numbersOf(const std::filesystem::path& report, const std::string& prefix);

/// Stage times of a summary.json. Throws InputError.
std::map<std::string, StageTotal> stageTotalsOf(const std::filesystem::path& summary);

}  // namespace roomgraph
