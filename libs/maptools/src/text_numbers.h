// SPDX-License-Identifier: BSD-3-Clause
// Numbers in text files.
#pragma once

#include <cmath>
#include <cstdio>
#include <string>

namespace roomgraph {

/// With so many digits after the point, whatever the locale's; never "-0.000".
inline std::string decimals(double value, int digits = 3) {
  const double unit = std::pow(10.0, -digits);
  if (std::abs(value) < unit / 2) value = 0;
  char text[64];
  std::snprintf(text, sizeof text, "%.*f", digits, value);
  return text;
}

}  // namespace roomgraph
