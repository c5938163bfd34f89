// SPDX-License-Identifier: BSD-3-Clause
// UsualRoughness: scans that are much noisier than those before.
#pragma once

#include <optional>

#include "roomgraph/observations/scan.h"

namespace roomgraph {

/// Follows the median roughness of scans.
class UsualRoughness {
 public:
  /// Whether the scan stands out from those before. It counts in any case: what lasts, for some 200 scans, becomes usual.
  bool standsOut(const Scan& scan);

 private:
  std::optional<double> usual_m_;
};

}  // namespace roomgraph
