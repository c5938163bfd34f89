// SPDX-License-Identifier: BSD-3-Clause
// JobFile: what a batch is to run, as its user wrote it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace roomgraph {

/// Recordings that are made by the simulator, one for each seed.
struct SimulatedInputs {
  std::filesystem::path world;  ///< empty: random flats, whose numbers are the seeds
  std::vector<std::int64_t> seeds;
  int rooms = 0;  ///< of flats; 0: drawn
  bool handheld = false;
  std::filesystem::path meshes;  ///< folder of catalogue models that furnish flats; empty: none
};

/// One entry of `inputs`.
struct InputEntry {
  std::vector<std::string> patterns;  ///< of file names, absolute
  std::optional<SimulatedInputs> simulated;
  std::string group;                         ///< empty: by the world, or the folder of the file
  std::map<std::string, std::string> truth;  ///< by kind (kTruthKinds); patterns with {folder}, {name}
  bool search_truth = true;                  ///< when `truth` is empty: beside the recording
  std::string place;                         ///< "jobs.yaml:7", for messages
};

/// One way to run every input.
struct BatchVariant {
  std::string name = "default";
  std::filesystem::path config;  ///< empty: the shipped one
  std::vector<std::string> overrides, poses;
};

struct BatchLimits {
  int jobs = 0;          ///< runs at once; 0: as many as cores / threads
  int threads = 1;       ///< of each run
  double memory_mb = 0;  ///< of all runs together; 0: what the machine has available
  double time_s = 0;     ///< of one run; 0: none
  int retries = 0;       ///< of a run that failed for no fault of its input or configuration
};

/// Long recordings in pieces that overlap, run side by side and are joined.
struct BatchSplit {
  double length_s = 0;    ///< of a piece, about; 0: recordings are run whole
  double overlap_s = 20;  ///< of a piece with the one before it
};

/// How array jobs are asked for (`--engine slurm`).
struct SlurmSettings {
  std::string partition;             ///< empty: the default one
  double time_s = 0;                 ///< of a job; 0: after the limit of a run
  double memory_mb = 0;              ///< of a job; 0: what its run is expected to need
  int cpus = 0;                      ///< of a job; 0: the threads of a run
  std::vector<std::string> options;  ///< of sbatch, like "--account=lab"
  std::vector<std::string> setup;    ///< lines of shell before the program starts
  double poll_s = 10;                ///< between two looks at the queue
  double patience_s = 60;            ///< for files of a job that has left the queue, on a slow shared folder
};

/// What a run leaves: figures; also its map and report; everything.
enum class Keep { kSummary, kMap, kAll };
Keep keepFromText(const std::string& text);  ///< Throws ConfigError that lists the names.
std::string toText(Keep keep);

struct JobFile {
  std::vector<InputEntry> inputs;
  std::vector<BatchVariant> variants{BatchVariant{}};
  BatchLimits limits;
  BatchSplit split;
  SlurmSettings slurm;
  Keep keep = Keep::kAll;
  /// Further words for `evaluate KIND`; "none": that evaluation is left out.
  std::map<std::string, std::vector<std::string>> evaluation;
};

/// trajectory (of the robot), camera_trajectory, objects, boxes, map, relations.
extern const std::vector<std::string> kTruthKinds;

/// Throws ConfigError: pieces that are not at least three times as long as what they have in common.
void requireSensibleSplit(const BatchSplit& split);

/// Reads a job file (docs/batch.md); relative names in it are in its folder, those of --set excepted. Throws
/// InputError (not readable) or ConfigError: file, line, key, cause.
JobFile readJobFile(const std::filesystem::path& file);

/// Recordings named one by one or by patterns on a command line.
JobFile jobsOfRecordings(const std::vector<std::string>& patterns);

/// "8 GB", "500 MB", "1.5 GiB"; a bare number is MB. Throws std::invalid_argument.
double megabytesOf(const std::string& text);
/// "90", "90 s", "30 min", "2 h". Throws std::invalid_argument.
double secondsOf(const std::string& text);
/// "1-3, 7" -> 1, 2, 3, 7. Throws std::invalid_argument.
std::vector<std::int64_t> numbersOfRanges(const std::string& text);

}  // namespace roomgraph
