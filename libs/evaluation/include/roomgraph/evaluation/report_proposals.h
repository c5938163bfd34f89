// SPDX-License-Identifier: BSD-3-Clause
// Results of the proposal benchmark as table and JSON.
#pragma once

#include <map>
#include <string>

#include "roomgraph/evaluation/proposal_error.h"

namespace roomgraph {

/// Everything `roomgraph bench proposals` measures.
struct ProposalBenchmark {
  std::map<std::string, ProposalFigures> per_class;
  GroundFigures ground;
  std::map<int, ErrorStatistics> cpu_ms;  ///< per frame, by number of boxes
};

/// Table for people; and the same as one JSON object with stable names.
std::string toTable(const ProposalBenchmark& benchmark);
std::string toJson(const ProposalBenchmark& benchmark);

/// One box as a line of JSON: time, id and class of the true object, box, and of the first proposal, when
/// there is one, source, score and errors.
std::string toJsonLine(const ProposalCase& c);

}  // namespace roomgraph
