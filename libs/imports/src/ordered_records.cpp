// SPDX-License-Identifier: BSD-3-Clause
// A queue by time that is emptied up to a window before the newest record.
#include "ordered_records.h"

#include <mrpt/core/Clock.h>

#include <algorithm>

namespace roomgraph {

void OrderedRecords::push(mrpt::obs::CObservation::Ptr record) {
  const double t = mrpt::Clock::toDouble(record->timestamp);
  newest_ = std::max(newest_, t);
  waiting_.emplace(t, std::move(record));
  release(newest_ - window_s_);
}

void OrderedRecords::finish() {
  release(newest_);
}

void OrderedRecords::release(double until) {
  while (!waiting_.empty() && waiting_.begin()->first <= until) {
    const auto& [t, record] = *waiting_.begin();
    late_ += t < last_;
    last_ = std::max(last_, t);
    ++written_[record->sensorLabel];
    sink_(*record);
    waiting_.erase(waiting_.begin());
  }
}

}  // namespace roomgraph
