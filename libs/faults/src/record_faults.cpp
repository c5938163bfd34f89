// SPDX-License-Identifier: BSD-3-Clause
// Removal, repetition and exchange of records.
#include "record_faults.h"

namespace roomgraph {

PassingRecords DropFault::pass(PassingRecord record) {
  if (!sensors_.contains(record.sensor) || !window_.contains(record.t)) return one(std::move(record));
  count(record);
  return {};
}

PassingRecords FreezeFault::pass(PassingRecord record) {
  if (record.sensor != sensor_ || record.t >= window_.to_s) return one(std::move(record));
  const auto last = last_.find(record.label());
  if (!window_.contains(record.t) || last == last_.end()) {
    last_.insert_or_assign(record.label(), record.clone());  // later faults change the record in place
    return one(std::move(record));
  }
  PassingRecord again = last->second.clone();
  again.observation->timestamp = record.observation->timestamp;
  again.t = record.t;
  changed(again);
  return one(std::move(again));
}

PassingRecords DuplicateFault::pass(PassingRecord record) {
  if (!sensors_.contains(record.sensor) || !window_.contains(record.t)) return one(std::move(record));
  count(record);
  PassingRecords twice = one(record.clone());
  twice.push_back(std::move(record));
  return twice;
}

PassingRecords SwapFault::pass(PassingRecord record) {
  const bool struck = sensors_.contains(record.sensor) && window_.contains(record.t);
  if (!struck && held_ && record.t >= window_.to_s) {
    PassingRecords rest = finish();
    rest.push_back(std::move(record));
    return rest;
  }
  if (!struck) return one(std::move(record));
  if (!held_) {
    held_ = std::move(record);
    return {};
  }
  count(record);
  count(*held_);
  PassingRecords swapped = one(std::move(record));
  swapped.push_back(std::move(*held_));
  held_.reset();
  return swapped;
}

PassingRecords SwapFault::finish() {
  if (!held_) return {};
  PassingRecords rest = one(std::move(*held_));
  held_.reset();
  return rest;
}

}  // namespace roomgraph
