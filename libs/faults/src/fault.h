// SPDX-License-Identifier: BSD-3-Clause
// Fault: one thing that goes wrong, as a filter of records.
#pragma once

#include <map>
#include <set>
#include <string>

#include "passing_record.h"

namespace roomgraph {

/// The sensors that a fault strikes.
using StruckSensors = std::set<FaultySensor>;

/// One thing that goes wrong. Gets the records one by one, in the order of the file.
class Fault {
 public:
  virtual ~Fault() = default;
  /// The records that stand for this one in the output.
  virtual PassingRecords pass(PassingRecord record) = 0;
  /// After the last record: what was held back.
  virtual PassingRecords finish() { return {}; }
  /// What there must be besides the records that it touches, in words; empty: nothing.
  virtual std::string needs() const { return {}; }
  /// Records touched so far, by label.
  const std::map<std::string, int>& counts() const { return counts_; }

 protected:
  void count(const PassingRecord& record) { ++counts_[record.label()]; }
  /// The record is not what it was: it counts, and its bytes are no longer true.
  void changed(PassingRecord& record) {
    count(record);
    record.bytes.clear();
  }
  static PassingRecords one(PassingRecord record) {
    PassingRecords records;
    records.push_back(std::move(record));
    return records;
  }

 private:
  std::map<std::string, int> counts_;
};

}  // namespace roomgraph
