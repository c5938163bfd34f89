// SPDX-License-Identifier: BSD-3-Clause
// Scripts of array jobs.
#pragma once

#include <filesystem>
#include <string>

#include "roomgraph/batch/job_file.h"

namespace roomgraph {

/// An array job to be.
struct ArrayJob {
  std::string name;
  std::filesystem::path folder, program;
  std::size_t tasks = 1;
  double memory_mb = 0;  ///< of a task
};

/// The text for sbatch.
std::string slurmScript(const JobFile& jobs, const ArrayJob& job);

/// Memory that a task is to ask for: what the job file says, or what it is expected to need, rounded up in
/// steps of a quarter so that tasks alike share an array.
double requestedMemory(const SlurmSettings& slurm, double expected_mb, double factor);

/// A word for the shell.
std::string shellQuoted(const std::string& word);

}  // namespace roomgraph
