// SPDX-License-Identifier: BSD-3-Clause
// One degree in radians, for values that people write in degrees.
#pragma once

#include <numbers>

namespace roomgraph {

inline constexpr double kDegree = std::numbers::pi / 180;

}  // namespace roomgraph
