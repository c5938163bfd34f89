// SPDX-License-Identifier: BSD-3-Clause
// Text files with times and sides: what they say about a variant of their recording.
#pragma once

#include <cstdint>

#include "roomgraph/faults/variant.h"

namespace roomgraph {

/// From the times of a recording to those of its variant.
class VariantTime {
 public:
  /// `first`, `last`: earliest and latest stamp, s, before anything changes.
  VariantTime(double first, double last, bool backwards) : sum_(first + last), backwards_(backwards) {}
  /// Stamps that are new: `was` becomes `is`. Those that are not named have no time any more.
  void move(double was, double is) { moved_[was] = is; }
  /// Nothing when stamps are new and none is within a millisecond.
  bool map(double& t) const;

 private:
  double sum_;
  bool backwards_;
  std::map<double, double> moved_;
};

/// The text of the truth's output. `image_width`: of the recording's images, 0 when there is none.
/// Throws InputError naming file, line and cause.
std::string variantOfTruth(const VariantTruth& truth, const VariantTime& time, const VariantOptions& options,
                           std::uint32_t image_width);

}  // namespace roomgraph
