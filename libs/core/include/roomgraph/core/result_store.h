// SPDX-License-Identifier: BSD-3-Clause
// ResultStore: results of costly computations, kept while a run goes on and given back when it is repeated.
#pragma once

#include <atomic>
#include <chrono>
#include <exception>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "roomgraph/core/allocation_limit.h"
#include "roomgraph/core/error_text.h"
#include "roomgraph/core/errors.h"
#include "roomgraph/core/journal.h"

namespace roomgraph {

/// Results that a run has computed, in the order in which they came. A run that was killed is repeated with
/// them: everything that asks gets what it computed the first time, as long as there are results left, and
/// computes again from there on. As the same input gives the same bits, the state behind all of this is that
/// of the first time; any beginning of the results will do. For computations that take much longer than their
/// results do to be read.
class ResultStore {
 public:
  virtual ~ResultStore() = default;
  /// The next result, when it is of that name and time (s, of the record); else nothing, now and ever after.
  virtual std::optional<std::string> recall(std::string_view name, double t) = 0;
  /// A result that was computed, as recall() gave nothing. Throws RunError when it cannot be written.
  virtual void keep(std::string_view name, double t, std::string_view bytes) = 0;
  /// Whether there are results left: work that is done before its turn would be in vain. Any thread may ask.
  virtual bool recalling() const { return false; }
};

/// Runs `decode(bytes)`. Throws InputError naming the result when they are none: only a file that somebody has changed,
/// with its checksums, gets so far.
template <class Decode>
auto decodedResult(std::string_view name, double t, const std::string& bytes, const Decode& decode)
    -> decltype(decode(bytes)) {
  // What containers of a damaged length ask for is refused before it is there.
  constexpr std::size_t kSpareBytes = 1u << 20, kBytesPerByte = 64;
  try {
    const AllocationLimit limit(kSpareBytes + kBytesPerByte * bytes.size());
    return decode(bytes);
  } catch (const std::exception& error) {
    throw InputError("checkpoint: its result '" + std::string(name) + "' of second " + std::to_string(t) +
                     " is damaged: " + firstLine(error));
  }
}

/// `compute()`, or what it gave the first time. `store` may be null. `encode` turns the result into bytes,
/// `decode` these into an equal result. Throws InputError when these are none.
template <class Compute, class Encode, class Decode>
auto recalled(ResultStore* store, std::string_view name, double t, const Compute& compute,
              const Encode& encode, const Decode& decode) -> decltype(compute()) {
  if (!store) return compute();
  if (const auto bytes = store->recall(name, t)) return decodedResult(name, t, *bytes, decode);
  auto result = compute();
  store->keep(name, t, encode(result));
  return result;
}

/// Numbers as the bytes of a result on this machine, and back. Throws std::invalid_argument: half a number.
std::string bytesOfNumbers(const std::vector<double>& numbers);
std::vector<double> numbersFrom(const std::string& bytes);

/// A ResultStore in a journal.
class JournalledResults : public ResultStore {
 public:
  /// What an earlier run with the same key left.
  struct Found {
    int results = 0;
    std::uintmax_t bytes = 0, damaged = 0;  ///< of sound results; behind them
  };
  /// `key`: of the run. `sync_s`: wall time after which results are on the disk, s; 0: none are kept. Throws
  /// RunError.
  JournalledResults(const std::filesystem::path& file, std::string_view key, double sync_s);

  std::optional<std::string> recall(std::string_view name, double t) override;
  void keep(std::string_view name, double t, std::string_view bytes) override;
  bool recalling() const override { return recalling_; }
  /// From now on nothing is recalled nor kept: what follows is no part of the whole run.
  void stop() { stopped_ = true; }

  const Found& found() const { return found_; }
  /// Neither found nor kept anything.
  bool empty() const { return found_.results + kept_ == 0; }
  /// Whether a result that was found was not what was asked for: the run did not repeat itself.
  bool diverged() const { return diverged_; }

 private:
  Found found_;
  Journal journal_;
  double sync_s_;
  std::chrono::steady_clock::time_point synced_ = std::chrono::steady_clock::now();
  int kept_ = 0;
  std::atomic<bool> recalling_ = true;
  bool stopped_ = false, diverged_ = false;
};

}  // namespace roomgraph
