// SPDX-License-Identifier: BSD-3-Clause
// Mixing and parsing of colours, and lookup by class.
#include "roomgraph/rendering/palette.h"

#include <cmath>
#include <cstdint>

namespace roomgraph::palette {

TColor mix(const TColor& a, const TColor& b, double ratio) {
  const auto channel = [ratio](int from, int to) {
    return static_cast<std::uint8_t>(std::lround(from + ratio * (to - from)));
  };
  return {channel(a.R, b.R), channel(a.G, b.G), channel(a.B, b.B), channel(a.A, b.A)};
}

TColor withAlpha(TColor color, int alpha) {
  color.A = static_cast<std::uint8_t>(alpha);
  return color;
}

TColor parse(const std::string& text) {
  if (text.size() != 7 || text[0] != '#' ||
      text.find_first_not_of("0123456789abcdefABCDEF", 1) != std::string::npos)
    return {136, 136, 136};
  const auto value = std::stoul(text.substr(1), nullptr, 16);
  return {static_cast<std::uint8_t>(value >> 16), static_cast<std::uint8_t>(value >> 8 & 255),
          static_cast<std::uint8_t>(value & 255)};
}

TColor ofClass(const ObjectDatabase& database, const std::string& class_name) {
  const ObjectModel* model = database.find(class_name);
  return parse(model ? model->color : "");
}

}  // namespace roomgraph::palette
