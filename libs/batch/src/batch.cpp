// SPDX-License-Identifier: BSD-3-Clause
// Folder, lock and catalogue around a batch at work; the plan in words.
#include "roomgraph/batch/batch.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <optional>

#include "batch_at_work.h"
#include "roomgraph/core/errors.h"

namespace roomgraph {

namespace fs = std::filesystem;

BatchLock::BatchLock(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder / "runs", error);
  if (error) throw RunError(folder.string() + ": cannot be made: " + error.message());
  const fs::path file = folder / "batch.lock";
  descriptor_ = open(file.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0666);
  if (descriptor_ < 0) throw RunError("cannot write " + file.string() + ": " + std::strerror(errno));
  if (flock(descriptor_, LOCK_EX | LOCK_NB) == 0) return;
  close(descriptor_);
  throw RunError(folder.string() + ": another batch is at work in it");
}

BatchLock::~BatchLock() {
  close(descriptor_);
}

BatchOutcome runBatch(const BatchPlan& plan, const fs::path& folder, const BatchProgram& program,
                      RunInspector& inspector, Engine& engine, const BatchView& view,
                      const std::function<bool()>& interrupted, const BatchLock&) {
  Catalogue catalogue = Catalogue::forWriting(folder / "catalogue.sqlite");
  catalogue.importFolder(folder / "runs");  // what a batch that was killed left behind
  return BatchAtWork(plan, folder, program, inspector, engine, view, catalogue).work(interrupted);
}

PlanInWords describePlan(const BatchPlan& plan, const fs::path& folder, const BatchProgram& program,
                         RunInspector& inspector) {
  std::optional<Catalogue> catalogue;
  if (fs::exists(folder / "catalogue.sqlite"))
    catalogue.emplace(Catalogue::forReading(folder / "catalogue.sqlite"));
  FileHashes hashes(catalogue ? &*catalogue : nullptr, nullptr);
  const RunPreparer preparer(plan, folder, program, inspector, hashes);
  const MemoryForecast forecast(catalogue ? catalogue->pastCosts() : std::vector<PastCost>());
  PlanInWords out;
  std::string& text = out.text;
  std::size_t& needed = out.needed;
  for (std::size_t i = 0; i < plan.inputs.size(); ++i)
    if (!preparer.isReady(i)) text += "simulate  " + plan.inputs[i].input.name + "\n";
  for (std::size_t run = 0; run < plan.runs.size(); ++run) {
    const std::string& name = plan.runs[run].name;
    if (!preparer.isReady(plan.runs[run].input)) {
      text += "run       " + name + " (once it is simulated)\n";
      ++needed;
      continue;
    }
    try {
      const PreparedRun prepared = preparer.prepare(run);
      const char* what = !prepared.needed          ? "keep      "
                         : prepared.task.run_again ? "run       "
                                                   : "evaluate  ";
      text += what + name + " (" + prepared.why + "), evaluated:";
      for (const auto& step : prepared.task.evaluations) text += " " + step.report;
      text += prepared.task.evaluations.empty() ? " nothing, for want of truth\n" : "\n";
      needed += prepared.needed;
      const RunInput& input = prepared.task.planned.input;
      if (prepared.needed)
        out.memory_mb = std::max(out.memory_mb, forecast.expected(input.sha256, input.bytes));
    } catch (const InputError& error) {
      text += "fail      " + name + ": " + error.what() + "\n";
    }
  }
  text += std::to_string(needed) + " of " + std::to_string(plan.runs.size()) +
          " runs to do: " + std::to_string(plan.inputs.size()) + " inputs, " +
          std::to_string(plan.variants.size()) + " variants\n";
  return out;
}

}  // namespace roomgraph
