// SPDX-License-Identifier: BSD-3-Clause
// One JSON object per line.
#include "lost_list.h"

#include <nlohmann/json.hpp>

#include "roomgraph/core/errors.h"

namespace roomgraph {

std::vector<LostRow> readLost(std::istream& lines, double start_t) {
  std::vector<LostRow> out;
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    try {
      const auto span = nlohmann::json::parse(line);
      out.push_back({span.at("sensor"), span.at("why"), span.at("from").get<double>() - start_t,
                     span.at("to").get<double>() - start_t, span.at("records")});
    } catch (const nlohmann::json::exception&) {
      throw InputError("lost.jsonl:" + std::to_string(number) + ": is no span of a sensor");
    }
  }
  return out;
}

}  // namespace roomgraph
