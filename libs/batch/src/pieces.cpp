// SPDX-License-Identifier: BSD-3-Clause
// Spans of pieces; measures of recordings, remembered.
#include <algorithm>
#include <cmath>
#include <fstream>

#include "roomgraph/batch/plan.h"
#include "roomgraph/catalogue/catalogue.h"
#include "roomgraph/core/output_file.h"

namespace roomgraph {
namespace {

// A recording that is a quarter longer than a piece is run whole.
constexpr double kHardlyLonger = 0.25;
// In lengths of a piece: of a longer one, a piece of two that cover 1.25 lengths may have hardly a record.
constexpr double kLongestGap = 0.5;

}  // namespace

RecordingMeasure measureOf(std::vector<double> stamps) {
  RecordingMeasure out;
  if (stamps.empty()) return out;
  std::sort(stamps.begin(), stamps.end());
  out.seconds = stamps.back() - stamps.front();
  for (std::size_t i = 1; i < stamps.size(); ++i)
    out.longest_gap_s = std::max(out.longest_gap_s, stamps[i] - stamps[i - 1]);
  return out;
}

bool hasEmptyPieces(const RecordingMeasure& measure, const BatchSplit& split) {
  return split.length_s > 0 && measure.longest_gap_s > kLongestGap * split.length_s;
}

std::vector<PieceSpan> piecesOf(const RecordingMeasure& measure, const BatchSplit& split) {
  if (split.length_s <= 0 || hasEmptyPieces(measure, split)) return {};
  const double count = std::ceil(measure.seconds / split.length_s - kHardlyLonger);
  if (count < 2) return {};
  const double length = measure.seconds / count;
  std::vector<PieceSpan> out;
  for (double i = 0; i < count; ++i)
    out.push_back({i > 0 ? i * length - split.overlap_s : 0, i + 1 < count ? (i + 1) * length : 0});
  return out;
}

void writeMeasure(const std::filesystem::path& file, const std::filesystem::path& rawlog,
                  const RecordingMeasure& measure) {
  writeFileAtomically(
      file, stampOf(rawlog) + "\n" + std::to_string(measure.seconds) + "\n" + measure.sha256 +
                                "\n" + std::to_string(measure.longest_gap_s) + "\n");
}

std::optional<RecordingMeasure> readMeasure(const std::filesystem::path& file,
                                            const std::filesystem::path& rawlog) {
  std::ifstream in(file);
  std::string stamp;
  RecordingMeasure measure;
  if (!std::getline(in, stamp) || stamp != stampOf(rawlog) || !(in >> measure.seconds >> measure.sha256 >> measure.longest_gap_s))
    return std::nullopt;
  return measure;
}

}  // namespace roomgraph
