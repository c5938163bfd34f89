// SPDX-License-Identifier: BSD-3-Clause
// run.json beside the journal of results; taking up a run by the words that began it.
#include "run_checkpoint.h"

#include <algorithm>
#include <iostream>
#include <nlohmann/json.hpp>

#include "program.h"
#include "roomgraph/core/checksum.h"
#include "roomgraph/core/errors.h"
#include "roomgraph/core/output_file.h"
#include "roomgraph/core/text_file.h"
#include "roomgraph/pipeline/run_output.h"
#include "roomgraph/pipeline/settings_json.h"

namespace roomgraph {
namespace {

namespace fs = std::filesystem;
using CheckpointJson = nlohmann::ordered_json;

constexpr int kFormat = 3;
constexpr const char *kRunFile = "run.json", *kJournalFile = "results.journal";

/// What run.json says.
struct KeptRun {
  RunBegun begun;
  fs::path working_directory;
  std::string text;  ///< all of it
};

KeptRun readKeptRun(const fs::path& file) {
  KeptRun run;
  run.text = readTextFile(file);
  const auto json = parseJson<CheckpointJson>(run.text, file.string());
  try {
    if (json.at("format") != kFormat) throw InputError(file.string() + ": is of another version of the program; without --resume the run begins anew");
    run.begun.command = json.at("command").get<std::vector<std::string>>();
    run.working_directory = json.at("working_directory").get<std::string>();
    for (const auto& part : json.at("belongs_to")) run.begun.identity.emplace_back(part.at(0), part.at(1));
    std::vector<ClockSetting> clocks;
    for (const auto& clock : json.at("clocks")) clocks.push_back(clockFrom(clock));
    std::vector<MountSetting> mounts;
    for (const auto& mount : json.at("sensor_poses")) mounts.push_back(mountFrom(mount));
    run.begun.beginnings = {json.at("begun"), clocks, mounts};
  } catch (const CheckpointJson::exception& error) {
    throw InputError(file.string() + ": " + firstLine(error));
  }
  return run;
}

bool isWhole(const fs::path& folder) {
  try {
    const fs::path file = folder / "summary.json";
    return parseJson<CheckpointJson>(readTextFile(file), file.string()).at("interrupted") == "no";
  } catch (const std::exception&) {
    return false;
  }
}

void enter(const fs::path& directory, const std::string& out) {
  std::error_code error;
  fs::current_path(directory, error);
  if (error)
    throw InputError(out + ": the run was begun in " + directory.string() +
                     ", which cannot be entered: " + error.message());
}

}  // namespace

RunCheckpoint::RunCheckpoint(const OutputFolder& files, const RunBegun& run, double sync_s, bool resume)
    : folder_(files.checkpoint()) {
  const fs::path file = folder_ / kRunFile;
  if (!resume) begin(run);
  const KeptRun kept = readKeptRun(file);
  if (const auto difference = differenceOf(kept.begun.identity, run.identity); !difference.empty())
    throw ConfigError(folder_.string() + " is of another run: " + difference +
                      "; without --resume the run begins anew");
  command_ = kept.begun.command;
  results_ = std::make_unique<JournalledResults>(folder_ / kJournalFile, sha256Of(kept.text), sync_s);
}

RunCheckpoint::~RunCheckpoint() {
  if (results_ && results_->empty()) discard();
}

void RunCheckpoint::discard() const {
  std::error_code ignored;
  fs::remove_all(folder_, ignored);
}

void RunCheckpoint::begin(const RunBegun& run) const {
  std::error_code error;
  fs::remove_all(folder_, error);
  fs::create_directory(folder_, error);
  if (error) throw RunError("cannot make " + folder_.string() + ": " + error.message());
  CheckpointJson json{{"format", kFormat},
                      {"command", run.command},
                      {"working_directory", fs::current_path().string()},
                      {"begun", run.beginnings.begun()},
                      {"clocks", CheckpointJson::array()},
                      {"sensor_poses", CheckpointJson::array()},
                      {"belongs_to", CheckpointJson::array()}};
  for (const ClockSetting& clock : run.beginnings.clocks()) json["clocks"].push_back(jsonOf(clock));
  for (const MountSetting& mount : run.beginnings.mounts()) json["sensor_poses"].push_back(jsonOf(mount));
  for (const auto& [name, value] : run.identity) json["belongs_to"].push_back({name, value});
  try {
    // Names may be no UTF-8.
    writeFileAtomically(folder_ / kRunFile,
                        json.dump(1, ' ', false, CheckpointJson::error_handler_t::replace) + "\n");
  } catch (const RunError&) {
    fs::remove_all(folder_, error);
    throw;
  }
}

std::string RunCheckpoint::whatIsThere() const {
  const JournalledResults::Found& found = results_->found();
  char text[160];
  std::snprintf(text, sizeof text, "%d results of the interrupted run are there (%.1f MB)", found.results,
                static_cast<double>(found.bytes) / 1e6);
  std::string line = text;
  if (found.damaged > 0)
    line += "; " + std::to_string(found.damaged) + " bytes behind them are damaged and left out";
  return line;
}

RunBeginnings beginningsOfCheckpoint(const fs::path& output) {
  const fs::path file = output / "roomgraph_checkpoint" / kRunFile;
  std::error_code none;
  return fs::exists(file, none) ? readKeptRun(file).begun.beginnings : RunBeginnings();
}

std::optional<RunOptions> optionsToResume(const RunOptions& now) {
  const fs::path out = fs::absolute(now.resume).lexically_normal();
  std::error_code none;
  if (!now.output.empty() && !fs::equivalent(now.output, out, none))
    throw ConfigError("--resume " + now.resume + ": is not the output folder " + now.output);
  if (!fs::is_directory(out, none)) throw InputError(now.resume + ": no such folder, so no checkpoint");
  // Completes what was cut off while files got into their places; sees whether the folder is in use.
  { const RunOutput former(out, {}); }
  const fs::path file = out / "roomgraph_checkpoint" / kRunFile;
  if (!fs::exists(file, none)) {
    if (!isWhole(out)) throw InputError(now.resume + ": there is no checkpoint of a run in it");
    std::cout << now.resume << " holds the results of a whole run: there is nothing to go on with\n";
    return std::nullopt;
  }
  RunOptions options = now;
  options.resume = out.string();
  if (!now.input.empty()) {
    options.output = now.output.empty() ? now.resume : now.output;
    return options;
  }
  const KeptRun run = readKeptRun(file);
  if (!options.progress.empty()) options.progress = fs::absolute(options.progress).string();
  options = withWordsOf(run.begun.command, options);
  options.output = out.string();
  enter(run.working_directory, now.resume);
  return options;
}

}  // namespace roomgraph
