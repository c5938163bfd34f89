// SPDX-License-Identifier: BSD-3-Clause
// Spans of pieces; lengths of recordings, remembered.
#include <cmath>
#include <fstream>

#include "roomgraph/batch/plan.h"
#include "roomgraph/catalogue/catalogue.h"
#include "roomgraph/core/output_file.h"

namespace roomgraph {
namespace {

// A recording that is a quarter longer than a piece is run whole.
constexpr double kHardlyLonger = 0.25;

}  // namespace

std::vector<PieceSpan> piecesOf(double seconds, const BatchSplit& split) {
  if (split.length_s <= 0) return {};
  const double count = std::ceil(seconds / split.length_s - kHardlyLonger);
  if (count < 2) return {};
  const double length = seconds / count;
  std::vector<PieceSpan> out;
  for (double i = 0; i < count; ++i)
    out.push_back({i > 0 ? i * length - split.overlap_s : 0, i + 1 < count ? (i + 1) * length : 0});
  return out;
}

void writeLength(const std::filesystem::path& file, const std::filesystem::path& rawlog, double seconds) {
  writeFileAtomically(file, stampOf(rawlog) + "\n" + std::to_string(seconds) + "\n");
}

std::optional<double> readLength(const std::filesystem::path& file, const std::filesystem::path& rawlog) {
  std::ifstream in(file);
  std::string stamp;
  double seconds = 0;
  if (!std::getline(in, stamp) || stamp != stampOf(rawlog) || !(in >> seconds)) return std::nullopt;
  return seconds;
}

}  // namespace roomgraph
