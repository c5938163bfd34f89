// SPDX-License-Identifier: BSD-3-Clause
// Keys by which it is known whether a run, its evaluation, its detections or its input would come out the
// same again.
#pragma once

#include "file_hashes.h"
#include "roomgraph/batch/batch.h"
#include "roomgraph/batch/run_task.h"

namespace roomgraph {

/// Of what `roomgraph run` makes: recording, effective configuration, objects, networks, places of sensors,
/// program.
std::string runKey(const std::string& recording, const RunNeeds& needs, const BatchVariant& variant,
                   const std::string& program, FileHashes& hashes);

/// Of the detections of a recording; empty: they are not shared.
std::string detectionKey(const std::string& recording, const RunNeeds& needs, const std::string& program,
                         FileHashes& hashes);

/// Of the evaluation: files of the truth and words of the commands.
std::string evaluationKey(const TruthFiles& truth, const JobFile& jobs, const std::string& program,
                          FileHashes& hashes);

/// Of a simulated recording. Throws InputError: no such world.
std::string simulationKey(const PlannedInput& input, const std::string& simulator, FileHashes& hashes);

/// Why a run is done again, in words, from its earlier result.
std::string whatChanged(const RunResult& before, const RunResult& now);

/// The evaluations that this truth allows of the run in `folder`.
std::vector<EvaluationStep> evaluationSteps(const TruthFiles& truth, const std::filesystem::path& folder,
                                            const JobFile& jobs);

}  // namespace roomgraph
