// SPDX-License-Identifier: BSD-3-Clause
// Part of roomgraph, object-level semantic SLAM.
#include "json_lines.h"

#include <fstream>
#include <stdexcept>

#include "roomgraph/core/errors.h"

namespace roomgraph {

int forEachJsonLine(const std::filesystem::path& file,
                    const std::function<void(const nlohmann::json&)>& use) {
  std::ifstream in(file);
  if (!in || std::filesystem::is_directory(file)) throw InputError(file.string() + ": cannot be opened");
  int number = 0;
  for (std::string line; std::getline(in, line);) {
    ++number;
    if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
    try {
      use(nlohmann::json::parse(line));
    } catch (const std::exception& error) {
      throw InputError(file.string() + ":" + std::to_string(number) + ": " + error.what());
    }
  }
  return number;
}

Box2 boxFrom(const nlohmann::json& numbers) {
  const auto box = numbers.get<std::vector<double>>();
  if (box.size() != 4) throw std::invalid_argument("bbox must have 4 numbers");
  return {box[0], box[1], box[2], box[3]};
}

}  // namespace roomgraph
