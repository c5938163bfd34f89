// SPDX-License-Identifier: BSD-3-Clause
// Where in a file the clock of a sensor jumps against those of the others.
#pragma once

#include <map>
#include <string>

#include "roomgraph/datasets/rawlog_reader.h"

namespace roomgraph {

/// Follows the stamps of all sensors in the order of the file. After a pause of all the first sensor that goes on seems to jump.
class StampJumps {
 public:
  /// Stamp of the next record, of `sensor`. Whether its clock has jumped by about `expected_s` (0: is not asked), and not back since.
  bool add(const std::string& sensor, double t, double expected_s);
  /// Since its last record.
  bool jumped(const std::string& sensor) const;
  const StampJumpsBySensor& found() const { return found_; }

 private:
  struct Stamps {
    double t = 0, interval_s = 0;  ///< of the last record, and since the one before
    double lead_s = 0;             ///< of the last one, over the latest stamps of other sensors
    bool jumped = false;
  };
  std::map<std::string, Stamps> sensors_;
  StampJumpsBySensor found_;
};

}  // namespace roomgraph
