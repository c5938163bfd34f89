// SPDX-License-Identifier: BSD-3-Clause
// What has to be done for an input before its runs: it is simulated, measured, cut into pieces.
#include "batch_at_work.h"

#include "roomgraph/core/errors.h"

namespace roomgraph {
namespace {

namespace fs = std::filesystem;

// A simulated recording is written as it comes; its renderer is what takes memory.
constexpr double kSimulation_mb = 400;
constexpr double kReading_mb = 200;

}  // namespace

EngineTask BatchAtWork::simulationOf(std::size_t input) const {
  const fs::path folder = preparer_.folderOfInput(input);
  EngineTask task{input, {program_.file.string(), "simulate"}, folder.string() + ".log", kSimulation_mb};
  const auto& words = plan_.inputs[input].simulate;
  task.command.insert(task.command.end(), words.begin(), words.end());
  task.command.insert(task.command.end(), {"-o", folder.string(), "--quiet"});
  return task;
}

EngineTask BatchAtWork::lengthTaskOf(std::size_t input) const {
  const fs::path file = preparer_.lengthFileOf(input);
  return {input,
          {program_.file.string(), "batch-length", preparer_.recordingOf(input).string(), file.string()},
          file.string() + ".log",
          kReading_mb};
}

// Simulated inputs are made; of those that are to be split the length is found out.
BatchAtWork::Step BatchAtWork::tryInput(std::size_t input) {
  if (ready_inputs_.contains(input)) return Step::kOver;
  if (inputs_underway_.contains(input)) return Step::kWaits;
  if (!preparer_.isReady(input)) return startInput(simulationOf(input));
  if (plan_.jobs.split.length_s > 0 && !preparer_.lengthOf(input)) return startInput(lengthTaskOf(input));
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
  const auto length = preparer_.lengthOf(plan_.runs[run].input);
  const auto spans = length ? piecesOf(*length, plan_.jobs.split) : std::vector<PieceSpan>();
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
    failed_inputs_[input] =
        "its input " + name + " could not be " + (simulated ? "simulated" : "measured") + " (" +
        (ended.reason.empty() ? "exit code " + std::to_string(ended.exit_code) : ended.reason) + "): see " +
        (simulated ? preparer_.folderOfInput(input).string() : preparer_.lengthFileOf(input).string()) +
        ".log";
    return;
  }
  if (simulated) preparer_.markReady(input, true);
  if (simulated) display_.event("simulated " + name);
}

}  // namespace roomgraph
