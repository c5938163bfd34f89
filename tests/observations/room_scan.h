// SPDX-License-Identifier: BSD-3-Clause
// Scan of an empty rectangular room in closed form.
#pragma once

#include <mrpt/core/Clock.h>
#include <mrpt/obs/CObservation2DRangeScan.h>

#include <algorithm>
#include <cmath>

namespace roomgraph::test {

/// A level scan from the middle of a room of this half size.
inline mrpt::obs::CObservation2DRangeScan scanOfRoom(double half_x, double half_y) {
  mrpt::obs::CObservation2DRangeScan scan;
  constexpr int kBeams = 360;
  scan.aperture = static_cast<float>(2 * M_PI);
  scan.maxRange = 10;
  scan.timestamp = mrpt::Clock::fromDouble(1700000001);
  scan.resizeScan(kBeams);
  for (int i = 0; i < kBeams; ++i) {
    const double angle = -M_PI + 2 * M_PI * i / (kBeams - 1);
    const double range = std::min(half_x / std::max(1e-9, std::abs(std::cos(angle))),
                                  half_y / std::max(1e-9, std::abs(std::sin(angle))));
    scan.setScanRange(static_cast<std::size_t>(i), static_cast<float>(range));
    scan.setScanRangeValidity(static_cast<std::size_t>(i), true);
  }
  return scan;
}

}  // namespace roomgraph::test
