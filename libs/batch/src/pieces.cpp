// SPDX-License-Identifier: BSD-3-Clause
// Spans of pieces; measures of recordings, remembered.
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

void writeMeasure(const std::filesystem::path& file, const std::filesystem::path& rawlog,
                  const RecordingMeasure& measure) {
  writeFileAtomically(
      file, stampOf(rawlog) + "\n" + std::to_string(measure.seconds) + "\n" + measure.sha256 + "\n");
}

std::optional<RecordingMeasure> readMeasure(const std::filesystem::path& file,
                                            const std::filesystem::path& rawlog) {
  std::ifstream in(file);
  std::string stamp;
  RecordingMeasure measure;
  if (!std::getline(in, stamp) || stamp != stampOf(rawlog) || !(in >> measure.seconds >> measure.sha256))
    return std::nullopt;
  return measure;
}

}  // namespace roomgraph
