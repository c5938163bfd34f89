// SPDX-License-Identifier: BSD-3-Clause
// Parser of the description of a chessboard.
#include "roomgraph/calibration/board.h"

#include <algorithm>
#include <charconv>
#include <string_view>

#include "roomgraph/core/errors.h"

namespace roomgraph {
namespace {

constexpr int kLeastCorners = 3, kMostCorners = 50;
constexpr double kLeastSquare_m = 0.005, kMostSquare_m = 1;

// Reads a number off the front of `text`, and the "x" after it when another one is to follow.
template <class T>
bool take(std::string_view& text, T& out, bool last) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), out);
  if (error != std::errc{}) return false;
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  if (last) return text.empty();
  if (text.empty() || text.front() != 'x') return false;
  text.remove_prefix(1);
  return true;
}

}  // namespace

Board parseBoard(const std::string& text, const std::string& context) {
  const auto refuse = [&](const std::string& why) {
    return ConfigError(context + ": " + why +
                       "; expected inner corners along a row and along a column, and the edge of a square in metres, "
                       "like 9x6x0.04");
  };
  Board out;
  std::string_view rest = text;
  if (!take(rest, out.columns, false) || !take(rest, out.rows, false) || !take(rest, out.square_m, true))
    throw refuse("'" + text + "' is no board");
  if (std::min(out.columns, out.rows) < kLeastCorners || std::max(out.columns, out.rows) > kMostCorners)
    throw refuse("a board has 3 to 50 inner corners along an edge");
  if (!(out.square_m >= kLeastSquare_m && out.square_m <= kMostSquare_m))
    throw refuse("squares are of 0.005 to 1 m");
  return out;
}

}  // namespace roomgraph
