// SPDX-License-Identifier: BSD-3-Clause
// What has to be done for an input before its runs: it is simulated, measured, cut into pieces.
#include "batch_at_work.h"

#include <cmath>

#include "roomgraph/core/errors.h"
#include "roomgraph/core/text_file.h"
#include "tool_call.h"

namespace roomgraph {
namespace {

namespace fs = std::filesystem;

// A simulated recording is written as it comes; its renderer is what takes memory.
constexpr double kSimulation_mb = 400;
constexpr double kReading_mb = 200;
constexpr std::uintmax_t kReadHere_bytes = 100'000'000;  // a tenth of a second: less than a queue takes

// What a program said last.
std::string wordsIn(const fs::path& log) {
  constexpr std::string_view kName = "roomgraph: ";
  try {
    const std::string last = lastLineOf(readTextFile(log));
    return last.starts_with(kName) ? last.substr(kName.size()) : last;
  } catch (const InputError&) {
    return "";
  }
}

}  // namespace

EngineTask BatchAtWork::simulationOf(std::size_t input) const {
  const fs::path folder = preparer_.folderOfInput(input);
  EngineTask task{input, {program_.file.string(), "simulate"}, folder.string() + ".log", kSimulation_mb};
  const auto& words = plan_.inputs[input].simulate;
  task.command.insert(task.command.end(), words.begin(), words.end());
  task.command.insert(task.command.end(), {"-o", folder.string(), "--quiet", "--threads",
                                           std::to_string(plan_.jobs.limits.threads)});
  return task;
}

EngineTask BatchAtWork::measurementOf(std::size_t input) const {
  const fs::path file = preparer_.measureFileOf(input);
  return {input,
          {program_.file.string(), "batch-measure", preparer_.recordingOf(input).string(), file.string()},
          file.string() + ".log",
          kReading_mb};
}

// What is to be cut has to be measured; and where others work, reading every large recording is theirs, too.
bool BatchAtWork::isMeasured(std::size_t input) {
  const fs::path rawlog = preparer_.recordingOf(input);
  std::error_code none;
  const bool read_here = !engine_.isElsewhere() || fs::file_size(rawlog, none) < kReadHere_bytes;
  if (plan_.jobs.split.length_s <= 0 && (read_here || hashes_.knows(rawlog))) return true;
  const auto measure = preparer_.measureOf(input);
  if (measure && !hashes_.knows(rawlog)) hashes_.remember(rawlog, measure->sha256);
  return measure.has_value();
}

// Simulated inputs are made; recordings are measured.
BatchAtWork::Step BatchAtWork::tryInput(std::size_t input) {
  if (ready_inputs_.contains(input)) return Step::kOver;
  if (inputs_underway_.contains(input)) return Step::kWaits;
  if (!preparer_.isReady(input)) return startInput(simulationOf(input));
  if (!isMeasured(input)) return startInput(measurementOf(input));
  ready_inputs_.insert(input);
  return Step::kOver;
}

BatchAtWork::Step BatchAtWork::startInput(EngineTask task) {
  const std::size_t input = task.id;
  const bool simulated = task.command.at(1) == "simulate";
  if (engine_.remembers(task.command)) {
    engine_.takeUp(input, task.command);
  } else {
    if (!engine_.accepts(task.expected_memory_mb)) return Step::kFull;
    if (simulated) preparer_.markReady(input, false);
    makeFolder(simulated ? preparer_.folderOfInput(input) : task.log.parent_path());
    std::error_code none;
    fs::remove(task.log, none);
    engine_.start(task);
  }
  inputs_underway_[input] = display_.elapsed();
  display_.event((simulated ? "simulate  " : "measure   ") + plan_.inputs[input].input.name);
  return Step::kWaits;
}

void BatchAtWork::split(std::size_t run) {
  split_.insert(run);
  const auto measure = preparer_.measureOf(plan_.runs[run].input);
  if (!measure) return;
  if (hasEmptyPieces(*measure, plan_.jobs.split))
    display_.event("whole     " + plan_.runs[run].name + ": for " + std::to_string(std::lround(measure->longest_gap_s)) +
                   " s its stamps have no records (a pause, or a clock that jumps), so it is not cut into pieces");
  const auto spans = piecesOf(*measure, plan_.jobs.split);
  for (const auto& span : spans) {
    PlannedRun piece = plan_.runs[run];
    char number[24];
    std::snprintf(number, sizeof number, ".p%02zu", plan_.runs[run].pieces.size() + 1);
    piece.name += number;
    piece.span = span;
    piece.pieces.clear();
    plan_.runs[run].pieces.push_back(plan_.runs.size());
    waiting_.push_back(plan_.runs.size());
    plan_.runs.push_back(std::move(piece));
  }
}

bool BatchAtWork::waitsForPieces(std::size_t run) {
  const auto& pieces = plan_.runs[run].pieces;
  return std::any_of(pieces.begin(), pieces.end(),
                     [this](std::size_t piece) { return !over_.contains(piece); });
}

void BatchAtWork::takeInInput(std::size_t input, const EndedTask& ended) {
  inputs_underway_.erase(input);
  const std::string& name = plan_.inputs[input].input.name;
  const bool simulated = !preparer_.isReady(input);
  if (ended.exit_code != 0) {
    if (outcome_.interrupted) return;
    const fs::path log = simulated ? simulationOf(input).log : measurementOf(input).log;
    std::string why = ended.reason.empty() ? wordsIn(log) : ended.reason;
    if (why.empty()) why = "exit code " + std::to_string(ended.exit_code);
    failed_inputs_[input] = "its input " + name + " could not be " + (simulated ? "simulated" : "read") +
                            ": " + why + " (" + log.string() + ")";
    return;
  }
  if (!simulated && !isMeasured(input))
    failed_inputs_[input] = "its input " + name + " has changed while it was read";
  if (simulated) preparer_.markReady(input, true);
  if (simulated) display_.event("simulated " + name);
}

}  // namespace roomgraph
