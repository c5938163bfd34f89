// SPDX-License-Identifier: BSD-3-Clause
// Wall-clock and processor time of every call of a stage, and the memory after it.
#pragma once

#include <map>
#include <string>

#include "roomgraph/core/growing_list.h"
#include "roomgraph/core/meter.h"

namespace roomgraph {

/// How long the stages of a run take, call by call: MRPT's time logger keeps sums only, and those do not tell
/// whether a stage gets slower as the run goes on. Nothing computed depends on it.
class StageTimes {
 public:
  struct Call {
    double t = 0;       ///< of the record it was made for, s
    const char* stage;  ///< a literal
    double ms = 0;      ///< by the clock on the wall
    double cpu_ms = 0;  ///< of the thread that made the call
    double memory_mb = 0;  ///< that the program holds when the call ends; 0: the system does not tell
  };
  struct Totals {
    int calls = 0;
    double total_ms = 0, max_ms = 0;
  };

  /// Measures the call of one stage until it goes out of scope.
  class Measured {
   public:
    Measured(StageTimes& times, const char* stage);
    ~Measured();
    Measured(const Measured&) = delete;
    Measured& operator=(const Measured&) = delete;

   private:
    StageTimes& times_;
    const char* stage_;
    Meter meter_;
  };

  /// From now on calls are for the record of that time.
  void startRecord(double t) { t_ = t; }
  /// A call that another thread made for that record.
  void add(const char* stage, const Work& work);
  [[nodiscard]] Measured measure(const char* stage) { return {*this, stage}; }

  /// In the order in which they ended.
  const GrowingList<Call>& calls() const { return calls_; }
  std::map<std::string, Totals> totals() const;

 private:
  double t_ = 0;
  double memory_mb_ = 0;  ///< when last looked at
  GrowingList<Call> calls_;
};

}  // namespace roomgraph
