// SPDX-License-Identifier: BSD-3-Clause
// ClockWatch: finds where in a bag the clocks of all topics are set back.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace roomgraph::bags {

/// A place in a bag behind which clocks are set back.
struct ClockRestart {
  std::vector<std::uint64_t> before;  ///< messages of each topic that come before it
  std::int64_t back_ns = 0;           ///< by how much
};

/// Gets the times of messages in the order of the bag, and tells where they go back by more than a second and
/// go on from there: the clock of the computer was set back, or a simulation started again. A single wrong
/// time is none, nor is one topic whose clock differs from those of the others: the topics that come within
/// half a second behind the place must all have gone back.
class ClockWatch {
 public:
  /// `stream`: whose times are in order, a topic or one frame of tf. `decides`: it is asked whether all have
  /// gone back, being of the robot's own computer. `counts`: messages of each topic before this one.
  void take(const std::string& stream, std::int64_t t_ns, bool decides,
            const std::vector<std::uint64_t>& counts);
  /// At the end of the bag: decides what it has not told.
  void finish();
  const std::vector<ClockRestart>& restarts() const { return restarts_; }

 private:
  struct Clock {
    std::int64_t latest_ns = 0, before_ns = 0;  ///< the last two times
    std::int64_t held_ns = 0;                   ///< the last before the fall that is looked at
    std::int64_t first_ns = 0;                  ///< the first behind it, on the clock that is read now
    int count = 0;                              ///< of those behind it
    bool known = false;                         ///< came before it, too
    bool decides = false;

    bool fell() const { return latest_ns < held_ns; }
  };
  void look(const Clock& clock, std::int64_t t_ns, const std::vector<std::uint64_t>& counts);
  void decide();

  std::map<std::string, Clock> clocks_;
  std::optional<ClockRestart> fall_;  ///< that is looked at
  std::int64_t added_ns_ = 0;         ///< of all restarts
  std::vector<ClockRestart> restarts_;
};

}  // namespace roomgraph::bags
