// SPDX-License-Identifier: BSD-3-Clause
// Numbers for JSON files, rounded to a step so that they stay short.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <nlohmann/json.hpp>

namespace roomgraph {

/// To the nearest multiple of 1 / `per_unit`.
inline double roundedTo(double value, double per_unit) {
  return std::round(value * per_unit) / per_unit;
}

inline nlohmann::ordered_json numbersJson(const Eigen::VectorXd& values, double per_unit) {
  auto out = nlohmann::ordered_json::array();
  for (const double value : values) out.push_back(roundedTo(value, per_unit));
  return out;
}

}  // namespace roomgraph
