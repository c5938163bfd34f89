// SPDX-License-Identifier: BSD-3-Clause
// A chessboard that the camera sees during a calibration.
#pragma once

#include <string>

namespace roomgraph {

/// A flat chessboard that stands still: inner corners along its two edges, and the edge of a square.
struct Board {
  int columns = 0, rows = 0;
  double square_m = 0;

  bool operator==(const Board&) const = default;
};

/// "9x6x0.04": columns, rows, edge in metres. Throws ConfigError, naming `context`, on anything else, on fewer than
/// three corners along an edge, and on edges that are not between 5 mm and 1 m.
Board parseBoard(const std::string& text, const std::string& context);

}  // namespace roomgraph
