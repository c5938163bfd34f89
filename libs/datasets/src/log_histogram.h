// SPDX-License-Identifier: BSD-3-Clause
// Quantiles of any number of positive values, in bounded memory.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace roomgraph {

/// Counts values in bins that are .1 % wide. Depths of a wrong unit are a thousand times too large or small: from 1e-6 to 1e6
/// every size has its bins.
class LogHistogram {
 public:
  /// What is beyond the ends counts for them; what is no positive number for the lower one.
  void add(double value) {
    const double place = value > 0 ? std::clamp(kPerUnit * (std::log(value) - kLowest), 0.0, kBins - 1.0) : 0.0;
    ++counts_[static_cast<std::size_t>(place)];
    ++total_;
  }
  std::size_t size() const { return total_; }
  /// Quantile of `ratio` in [0, 1] by nearest rank, within .05 %; 0 for no values.
  double quantile(double ratio) const {
    if (total_ == 0) return 0;
    auto before = static_cast<std::size_t>(ratio * static_cast<double>(total_ - 1) + 0.5);
    std::size_t bin = 0;
    for (; before >= counts_[bin]; ++bin) before -= counts_[bin];
    return std::exp(kLowest + (static_cast<double>(bin) + 0.5) / kPerUnit);
  }

 private:
  static constexpr double kPerUnit = 1000, kLowest = -13.815511;  // of the natural logarithm
  static constexpr double kBins = 27'632;
  std::vector<std::uint64_t> counts_ = std::vector<std::uint64_t>(static_cast<std::size_t>(kBins));
  std::size_t total_ = 0;
};

}  // namespace roomgraph
