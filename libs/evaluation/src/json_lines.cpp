// SPDX-License-Identifier: BSD-3-Clause
// JSON lines parsed one by one; boxes of four numbers.
#include "json_lines.h"

#include <sstream>
#include <stdexcept>

#include "roomgraph/core/text_file.h"

namespace roomgraph {

int forEachJsonLine(const std::filesystem::path& file,
                    const std::function<void(const nlohmann::json&)>& use) {
  std::istringstream in(readTextFile(file));
  int number = 0;
  for (std::string line; std::getline(in, line);) {
    ++number;
    if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
    const std::string place = file.string() + ":" + std::to_string(number);
    const auto record = parseJson<nlohmann::json>(line, place);
    try {
      use(record);
    } catch (const std::exception& error) {
      throw InputError(place + ": " + firstLine(error));
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
