// SPDX-License-Identifier: BSD-3-Clause
// A ResultStore in memory, of which a repeated computation is given the first so many results.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "roomgraph/core/result_store.h"

namespace roomgraph::test {

/// Fails the test when the results are not asked for in the order in which they were kept.
class ResultsInMemory : public ResultStore {
 public:
  struct Result {
    std::string name;
    double t;
    std::string bytes;
  };
  std::optional<std::string> recall(std::string_view name, double t) override {
    if (next == recallable) return std::nullopt;
    const Result& result = all[next++];
    EXPECT_EQ(result.name, name);
    EXPECT_EQ(result.t, t);
    return result.bytes;
  }
  void keep(std::string_view name, double t, std::string_view bytes) override {
    all.push_back({std::string(name), t, std::string(bytes)});
    ++kept;
  }
  bool recalling() const override { return next < recallable; }
  /// For a repetition that has the first `count` of them.
  ResultsInMemory beginning(std::size_t count) const {
    ResultsInMemory out;
    out.all.assign(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(count));
    out.recallable = count;
    return out;
  }

  std::vector<Result> all;
  std::size_t next = 0, recallable = 0, kept = 0;
};

}  // namespace roomgraph::test
