// SPDX-License-Identifier: BSD-3-Clause
// Outliers among the roughness of records.
#include "roughness_watch.h"

#include "roomgraph/core/order_statistics.h"
#include "roomgraph/observations/roughness.h"

namespace roomgraph {

PoorRecords RoughnessWatch::noisy() const {
  std::vector<double> all;
  for (const auto& record : records_) all.push_back(record.roughness_m);
  const double limit = roughnessLimit(median(all));
  PoorRecords out;
  for (const auto& record : records_)
    if (record.roughness_m > limit && out.count++ == 0) out.first_time = record.t;
  return out;
}

}  // namespace roomgraph
