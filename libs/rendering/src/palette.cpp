// SPDX-License-Identifier: BSD-3-Clause
// Mixing and parsing of colours, and lookup by class.
#include "roomgraph/rendering/palette.h"

#include <cmath>
#include <cstdint>
#include <cstdio>

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

const std::vector<TColor>& colorBlindSafe() {
  static const std::vector<TColor> colors{{230, 159, 0}, {0, 114, 178},  {213, 94, 0},  {204, 121, 167},
                                          {0, 158, 115}, {86, 180, 233}, {240, 228, 66}};
  return colors;
}

ObjectDatabase withSafeColors(const ObjectDatabase& database) {
  const auto& safe = colorBlindSafe();
  std::string text;
  std::size_t index = 0;
  for (const auto& model : database.models()) {
    const std::size_t round = index / safe.size() % 3;
    const TColor color = round == 0   ? safe[index % safe.size()]
                         : round == 1 ? mix(safe[index % safe.size()], {0, 0, 0}, 0.45)
                                      : mix(safe[index % safe.size()], {255, 255, 255}, 0.5);
    ++index;
    char hex[8];
    std::snprintf(hex, sizeof hex, "#%02x%02x%02x", color.R, color.G, color.B);
    text += "[" + model.class_name + "]\nlabels = " + model.class_name + "\nshape = " + model.shape +
            "\nlandmark = " + (model.landmark ? "true" : "false") + "\ncolor = " + hex + "\n";
  }
  return ObjectDatabase::fromText(text, "colours");
}

}  // namespace roomgraph::palette
