// SPDX-License-Identifier: BSD-3-Clause
// BatchPlan: the inputs, variants and runs of a batch, with their names.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "roomgraph/batch/job_file.h"
#include "roomgraph/catalogue/run_result.h"

namespace roomgraph {

/// Files of the truth by kind (kTruthKinds).
using TruthFiles = std::map<std::string, std::filesystem::path>;

struct PlannedInput {
  RunInput input;                     ///< sha256 and bytes are not known yet
  std::vector<std::string> simulate;  ///< words for `roomgraph simulate` that make it; none: it is there
  bool search_truth = true;
  TruthFiles truth;  ///< named in the job file
};

/// Seconds after the first record of a recording.
struct PieceSpan {
  double from_s = 0;
  double until_s = 0;  ///< 0: the end
};

struct PlannedRun {
  std::string name;  ///< INPUT--VARIANT: its folder
  std::size_t input = 0, variant = 0;
  std::optional<PieceSpan> span;    ///< of a piece; its name ends in ".p01"
  std::vector<std::size_t> pieces;  ///< the runs that it is joined from, once they are known
};

struct BatchPlan {
  std::vector<PlannedInput> inputs;
  std::vector<BatchVariant> variants;
  std::vector<PlannedRun> runs;  ///< input by input; pieces come behind all others
  JobFile jobs;
};

/// Finds the recordings and gives everything its name, the same each time. `folder`: of the batch; simulated
/// inputs will be in FOLDER/inputs/NAME. Throws InputError: a pattern without any file, a truth that is not
/// there; ConfigError: an input that stands in two entries.
BatchPlan planBatch(const JobFile& jobs, const std::filesystem::path& folder);

/// What a look at all of a recording tells.
struct RecordingMeasure {
  double seconds = 0;  ///< from its earliest record to its latest
  std::string sha256;  ///< of its file
  double longest_gap_s = 0;  ///< between two stamps
};

/// Seconds and longest gap of a recording with these stamps, in any order.
RecordingMeasure measureOf(std::vector<double> stamps);

/// Whether a piece of that length could be without records: stamps jump, or the recording was paused.
bool hasEmptyPieces(const RecordingMeasure& measure, const BatchSplit& split);

/// Pieces of equal length, about as long as `split` says; none when the recording is hardly longer than one,
/// or has empty pieces.
std::vector<PieceSpan> piecesOf(const RecordingMeasure& measure, const BatchSplit& split);

/// A measure in a file of its own, which is valid while the recording has the same size and time. Nothing: it
/// is not known. Throws RunError.
void writeMeasure(const std::filesystem::path& file, const std::filesystem::path& rawlog,
                  const RecordingMeasure& measure);
std::optional<RecordingMeasure> readMeasure(const std::filesystem::path& file,
                                            const std::filesystem::path& rawlog);

/// The truth beside a recording: the simulator's files when it is the only recording in its folder, and files
/// that bear its name (NAME.rawlog.GT.txt, NAME.relations).
TruthFiles truthBeside(const std::filesystem::path& rawlog);

}  // namespace roomgraph
