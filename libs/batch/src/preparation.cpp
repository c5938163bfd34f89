// SPDX-License-Identifier: BSD-3-Clause
// Keys compared with those of the last result; words of the command.
#include "preparation.h"

#include <algorithm>

#include "roomgraph/core/checksum.h"
#include "roomgraph/core/errors.h"
#include "roomgraph/core/output_file.h"
#include "roomgraph/core/text_file.h"
#include "run_keys.h"
#include "truth_files.h"

namespace roomgraph {
namespace {

namespace fs = std::filesystem;

constexpr const char* kReadyFile = "input.key";

}  // namespace

void makeFolder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw RunError(folder.string() + ": cannot be made: " + error.message());
}

std::optional<RunResult> resultIn(const fs::path& folder) {
  lookInto(folder);
  try {
    return readRunResult(folder / "result.json");
  } catch (const InputError&) {  // no whole run is there
    return std::nullopt;
  }
}

RunPreparer::RunPreparer(const BatchPlan& plan, fs::path folder, const BatchProgram& program,
                         RunInspector& inspector, FileHashes& hashes)
    : plan_(plan),
      folder_(std::move(folder)),
      program_(program),
      inspector_(inspector),
      hashes_(hashes),
      program_hash_(hashes.of(program.parts)),
      simulator_hash_(hashes.of(program.simulator)) {}

fs::path RunPreparer::recordingOf(std::size_t input) const {
  const PlannedInput& planned = plan_.inputs[input];
  if (planned.simulate.empty()) return planned.input.path;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folderOfInput(input), error))
    if (entry.path().extension() == ".rawlog") return entry.path();
  throw InputError(folderOfInput(input).string() + ": holds no recording");
}

bool RunPreparer::isReady(std::size_t input) const {
  const PlannedInput& planned = plan_.inputs[input];
  if (planned.simulate.empty()) return true;
  try {
    return readTextFile(folderOfInput(input) / kReadyFile) ==
           simulationKey(planned, simulator_hash_, hashes_);
  } catch (const InputError&) {
    return false;
  }
}

void RunPreparer::markReady(std::size_t input, bool ready) const {
  const fs::path file = folderOfInput(input) / kReadyFile;
  std::error_code none;
  if (ready)
    writeFileAtomically(file, simulationKey(plan_.inputs[input], simulator_hash_, hashes_));
  else
    fs::remove(file, none);
}

RunResult RunPreparer::planned(std::size_t run) const {
  RunResult out;
  const PlannedRun& place = plan_.runs[run];
  out.name = place.name;
  out.variant = plan_.variants[place.variant].name;
  out.input = plan_.inputs[place.input].input;
  if (place.span) {  // in tables, pieces are not to be taken for whole recordings
    out.variant += kPieceSuffix;
    out.input.name += place.name.substr(place.name.rfind('.'));
  }
  out.version = program_.version;
  out.revision = program_.revision;
  out.program = program_hash_;
  return out;
}

void RunPreparer::requireSameProgram() const {
  if (hashes_.of(program_.parts) != program_hash_)
    throw RunError(
        program_.file.string() +
        ": has been replaced while the batch was at work; the same command again goes on with the new one");
}

std::vector<std::string> RunPreparer::runWords(std::size_t run, const fs::path& rawlog) const {
  const BatchVariant& variant = plan_.variants[plan_.runs[run].variant];
  const std::string folder = folderOf(run).string();
  std::vector<std::string> words{"run",
                                 rawlog.string(),
                                 "-o",
                                 folder,
                                 "--quiet",
                                 "--threads",
                                 std::to_string(plan_.jobs.limits.threads),
                                 "--progress-file",
                                 folder + "/progress"};
  if (!variant.config.empty()) words.insert(words.end(), {"--config", variant.config.string()});
  for (const auto& setting : variant.overrides) words.insert(words.end(), {"--set", setting});
  for (const auto& pose : variant.poses) words.insert(words.end(), {"--pose", pose});
  if (const auto& span = plan_.runs[run].span)
    words.insert(words.end(),
                 {"--from", std::to_string(span->from_s), "--until", std::to_string(span->until_s)});
  if (plan_.jobs.keep == Keep::kSummary) words.insert(words.end(), {"--no-snapshot", "--no-report"});
  return words;
}

std::vector<std::string> RunPreparer::joinWords(const PlannedRun& run, const fs::path& folder) const {
  std::vector<std::string> words{"map", "join"};
  for (const auto piece : run.pieces) words.push_back(folderOf(piece).string());
  words.insert(words.end(), {"-o", folder.string()});
  if (plan_.jobs.keep == Keep::kSummary) words.emplace_back("--no-snapshot");
  return words;
}

// A piece keeps what it is joined by, and is judged by its path only: what it did not see is not missing.
// What is joined changes with its pieces, and has no files for the evaluation of boxes.
void RunPreparer::fillIn(const PlannedRun& run, const RunNeeds& needs, PreparedRun& out) const {
  RunResult& result = out.task.planned;
  const std::string shared = detectionKey(result.input.sha256, needs, program_hash_, hashes_);
  if (!shared.empty() && run.pieces.empty())
    out.detections = folder_ / "detections" / (shared.substr(0, 24) + ".rawlog");
  if (run.span) {
    const std::string span = std::to_string(run.span->from_s) + " " + std::to_string(run.span->until_s);
    result.key = sha256Of(result.key + " " + span);
    if (!shared.empty())
      out.detections = folder_ / "detections" / (sha256Of(shared + " " + span).substr(0, 24) + ".rawlog");
    out.task.keep = std::max(out.task.keep, Keep::kMap);
    std::erase_if(out.task.evaluations,
                  [](const auto& step) { return step.report != "trajectory" && step.report != "relations"; });
  }
  if (run.pieces.empty()) return;
  std::string keys = "joined " + program_hash_;
  for (const auto piece : run.pieces) keys += " " + readRunResult(folderOf(piece) / "result.json").key;
  result.key = sha256Of(keys);
  out.task.run = joinWords(run, out.task.folder);
}

PreparedRun RunPreparer::prepare(std::size_t run) const {
  const PlannedRun& place = plan_.runs[run];
  const PlannedInput& input = plan_.inputs[place.input];
  const BatchVariant& variant = plan_.variants[place.variant];
  const fs::path rawlog = recordingOf(place.input);
  PreparedRun out;
  RunResult& result = out.task.planned = planned(run);
  result.input.path = rawlog.string();
  result.input.sha256 = hashes_.ofRecording(rawlog);
  result.input.bytes = static_cast<std::int64_t>(fs::file_size(rawlog));
  const RunNeeds needs = inspector_.needsOf(variant, rawlog);
  result.parameters = needs.parameters;
  result.key = runKey(result.input.sha256, needs, variant, program_hash_, hashes_);
  TruthFiles truth = input.search_truth ? truthBeside(rawlog) : input.truth;
  if (!place.pieces.empty()) truth.erase("boxes");  // they are compared with files that only a run leaves
  result.evaluation_key = evaluationKey(truth, plan_.jobs, program_hash_, hashes_);
  out.task.folder = folderOf(run);
  out.task.run = runWords(run, rawlog);
  out.task.evaluations = evaluationSteps(truth, out.task.folder, plan_.jobs);
  out.task.time_limit_s = plan_.jobs.limits.time_s;
  out.task.keep = plan_.jobs.keep;
  fillIn(place, needs, out);
  decide(out);
  return out;
}

void RunPreparer::decide(PreparedRun& run) const {
  const auto before = resultIn(run.task.folder);
  RunResult& now = run.task.planned;
  if (!before) {
    run.why = fs::exists(run.task.folder) ? "was not finished" : "new";
    return;
  }
  const bool same_run =
      before->complete() && before->key == now.key && keepFromText(before->keep) >= run.task.keep;
  run.needed = !same_run || before->evaluation_key != now.evaluation_key || !before->reason.empty();
  run.why = run.needed ? whatChanged(*before, now) : "unchanged";
  // Only the truth has changed, and all that an evaluation reads was kept.
  if (!run.needed || !same_run || before->keep != toText(Keep::kAll)) return;
  run.task.run_again = false;
  run.task.run = before->command;
  now.started = before->started;
  now.wall_s = before->wall_s;
  now.cpu_s = before->cpu_s;
  now.peak_memory_mb = before->peak_memory_mb;
  now.failures = before->failures;
}

void RunPreparer::shareDetections(PreparedRun& run, bool replay) {
  auto& words = run.task.run;
  if (!replay) {
    words.insert(words.end(), {"--save-detections", run.detections.string()});
    return;
  }
  // A microsecond: each record belongs to the very image that it was made of.
  for (const std::string& setting : {std::string("class=auto"), std::string("models="),
                                     "file=" + run.detections.string(), std::string("tolerance_s=0.000001")})
    words.insert(words.end(), {"--set", "detection." + setting});
}

}  // namespace roomgraph
