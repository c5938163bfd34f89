// SPDX-License-Identifier: BSD-3-Clause
// ContinuedClock: times that go on where the clocks of a bag are set back.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "clock_watch.h"

namespace roomgraph::bags {

/// Parts of a bag that is read a second time: part 0, and those behind the first, second … restart of a
/// clock.
class ClockParts {
 public:
  explicit ClockParts(std::vector<ClockRestart> restarts) : restarts_(std::move(restarts)) {}

  /// A message of a topic (index in the survey), of which `count` came before. `now_ns`: a clock that is
  /// never set back.
  void follow(std::size_t topic, std::uint64_t count, std::int64_t now_ns);
  /// The part that a time is of. `stream`: whose times are in order. What is from before a restart may come a
  /// little behind it: its stream goes on as before.
  std::size_t partOf(const std::string& stream, std::int64_t t_ns, std::int64_t now_ns);
  /// What makes times of a part go on from those before it.
  std::int64_t addedNs(std::size_t part) const;

 private:
  struct Stream {
    std::int64_t last_ns = 0;
    std::size_t part = 0;
  };
  std::vector<ClockRestart> restarts_;
  std::size_t part_ = 0;
  std::int64_t restarted_ns_ = 0;
  std::map<std::string, Stream> streams_;
};

/// Makes of the stamps of a bag times by which records can be ordered and transforms looked up although
/// clocks are set back in between.
class ContinuedClock {
 public:
  /// `stamps`: restarts of the clocks that stamp; `receptions`: of the recorder's.
  ContinuedClock(std::vector<ClockRestart> stamps, std::vector<ClockRestart> receptions);

  /// The next message of a topic, received then.
  void follow(std::size_t topic, std::int64_t received_ns);
  /// When it was received, on a clock that is not set back.
  std::int64_t receivedNs() const { return received_ns_; }
  /// The part that a stamp is of; `stream`: a topic, or one frame of tf.
  std::size_t partOf(const std::string& stream, std::int64_t stamp_ns) {
    return stamps_.partOf(stream, stamp_ns, now_ns_);
  }
  std::int64_t addedNs(std::size_t part) const { return stamps_.addedNs(part); }
  /// The same, and keeps parts apart: nothing of a part comes before the last of the part before it.
  std::int64_t apartNs(std::size_t part) const;

 private:
  ClockParts stamps_, receptions_;
  std::vector<std::uint64_t> counts_;  ///< messages of each topic so far
  std::int64_t received_ns_ = 0, now_ns_ = 0;
};

}  // namespace roomgraph::bags
