// SPDX-License-Identifier: BSD-3-Clause
// Insertion by time and kind of record, release after the look-ahead.
#include "roomgraph/pipeline/record_sorter.h"

#include <algorithm>
#include <tuple>

namespace roomgraph {
namespace {

int rank(const Record& record) {
  if (std::holds_alternative<Frame>(record)) return 2;
  return std::holds_alternative<Scan>(record) ? 1 : 0;
}

bool before(const Record& a, const Record& b) {
  return std::make_tuple(timeOf(a), rank(a)) < std::make_tuple(timeOf(b), rank(b));
}

}  // namespace

void RecordSorter::push(Record record) {
  latest_ = waiting_.empty() ? timeOf(record) : std::max(latest_, timeOf(record));
  const auto place = std::upper_bound(waiting_.begin(), waiting_.end(), record, before);
  waiting_.insert(place, std::move(record));
}

std::optional<Record> RecordSorter::pop(bool flush) {
  if (waiting_.empty()) return std::nullopt;
  if (!flush && timeOf(waiting_.front()) > latest_ - lookahead_s_) return std::nullopt;
  Record first = std::move(waiting_.front());
  waiting_.pop_front();
  return first;
}

}  // namespace roomgraph
