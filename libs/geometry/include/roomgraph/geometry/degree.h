// SPDX-License-Identifier: BSD-3-Clause
// Degrees and radians, for values that people read and write in degrees.
#pragma once

#include <numbers>

namespace roomgraph {

inline constexpr double kDegree = std::numbers::pi / 180;            ///< one degree, rad
inline constexpr double kDegreesPerRadian = 180 / std::numbers::pi;  ///< one radian, degrees

}  // namespace roomgraph
