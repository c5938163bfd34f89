// SPDX-License-Identifier: BSD-3-Clause
// Options of sbatch from limits and settings.
#include "slurm_script.h"

#include <cmath>

namespace roomgraph {
namespace {

// What a run may take beyond its limit: to write its results, and to be evaluated.
constexpr double kMoreTime = 1.1, kMoreTime_s = 600;
constexpr double kLeastMemory_mb = 256, kMemoryStep = 1.25;

double timeOfJob(const JobFile& jobs) {
  if (jobs.slurm.time_s > 0) return jobs.slurm.time_s;
  return jobs.limits.time_s > 0 ? kMoreTime * jobs.limits.time_s + kMoreTime_s : 0;
}

}  // namespace

double requestedMemory(const SlurmSettings& slurm, double expected_mb, double factor) {
  if (slurm.memory_mb > 0) return slurm.memory_mb * factor;
  const double steps = std::ceil(std::log(expected_mb / kLeastMemory_mb) / std::log(kMemoryStep) - 1e-9);
  return kLeastMemory_mb * std::pow(kMemoryStep, std::max(0.0, steps));
}

std::string shellQuoted(const std::string& word) {
  std::string out = "'";
  for (const char c : word) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

std::string slurmScript(const JobFile& jobs, const ArrayJob& job) {
  std::string text = "#!/bin/sh\n";
  const auto option = [&text](const std::string& words) { text += "#SBATCH " + words + "\n"; };
  option("--job-name=" + job.name);
  option("--array=0-" + std::to_string(job.tasks - 1));
  option("--output=\"" + (job.folder / "%a.out").string() + "\"");
  option("--nodes=1 --ntasks=1 --cpus-per-task=" +
         std::to_string(jobs.slurm.cpus > 0 ? jobs.slurm.cpus : jobs.limits.threads));
  option("--mem=" + std::to_string(std::lround(std::ceil(job.memory_mb))) + "M");
  if (const double time = timeOfJob(jobs); time > 0)
    option("--time=" + std::to_string(std::lround(std::ceil(time / 60))));
  if (!jobs.slurm.partition.empty()) option("--partition=" + jobs.slurm.partition);
  option("--no-requeue");
  for (const auto& words : jobs.slurm.options) option(words);
  for (const auto& line : jobs.slurm.setup) text += line + "\n";
  return text + "exec " + shellQuoted(job.program.string()) + " batch-element " +
         shellQuoted(job.folder.string()) + " \"$SLURM_ARRAY_TASK_ID\"\n";
}

}  // namespace roomgraph
