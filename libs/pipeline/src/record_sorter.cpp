// SPDX-License-Identifier: BSD-3-Clause
// Insertion by time and kind of record, release after the look-ahead.
#include "roomgraph/pipeline/record_sorter.h"

#include <algorithm>
#include <tuple>

namespace roomgraph {
namespace {

constexpr double kBoxesEarlier_s = 0.2;
constexpr double kFarAhead_s = 1;       // of a stamp that may be wrong
constexpr std::size_t kMostAhead = 32;  // that wait for another sensor to come there: images take memory

double sortedTime(const Record& record) { return timeOf(record) - (isBoxes(record) ? kBoxesEarlier_s : 0); }

int rank(const Record& record) {
  if (std::holds_alternative<Frame>(record)) return 2;
  return std::holds_alternative<Scan>(record) ? 1 : 0;
}

bool before(const Record& a, const Record& b) {
  return std::make_tuple(sortedTime(a), rank(a)) < std::make_tuple(sortedTime(b), rank(b));
}

}  // namespace

void RecordSorter::note(const Record& record) {
  const double t = timeOf(record);
  if (waiting_.empty()) {
    latest_ = t;
    ahead_.clear();
  } else if (t <= latest_ + kFarAhead_s) {
    latest_ = std::max(latest_, t);
  } else {
    double reached = t;
    bool others = false;
    for (const auto& [time, kind] : ahead_) {
      others = others || kind != record.index();
      reached = std::min(reached, time);
    }
    ahead_.emplace_back(t, record.index());
    if (others || ahead_.size() > kMostAhead) latest_ = reached;
  }
  std::sort(ahead_.begin(), ahead_.end());
  for (const auto& [time, kind] : ahead_)  // those that follow each other closely
    if (time <= latest_ + kFarAhead_s) latest_ = std::max(latest_, time);
  std::erase_if(ahead_, [&](const auto& one) { return one.first <= latest_ + kFarAhead_s; });
}

void RecordSorter::push(Record record) {
  note(record);
  boxes_come_ = boxes_come_ || isBoxes(record);
  const auto place = std::upper_bound(waiting_.begin(), waiting_.end(), record, before);
  waiting_.insert(place, std::move(record));
}

std::optional<Record> RecordSorter::pop(bool flush) {
  if (waiting_.empty()) return std::nullopt;
  const double wait_s = lookahead_s_ + (boxes_come_ ? kBoxesEarlier_s : 0);
  if (!flush && sortedTime(waiting_.front()) > latest_ - wait_s) return std::nullopt;
  Record first = std::move(waiting_.front());
  waiting_.pop_front();
  return first;
}

}  // namespace roomgraph
