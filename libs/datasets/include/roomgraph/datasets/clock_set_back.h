// SPDX-License-Identifier: BSD-3-Clause
// ClockSetBack: where in a recording the clock of all sensors was set back.
#pragma once

namespace roomgraph {

/// The clock of the computer that recorded was set back: from here on the stamps of all sensors are older than expected.
struct ClockSetBack {
  double t = 0;        ///< s; first stamp behind it, as recorded
  double seconds = 0;  ///< by how much
};

}  // namespace roomgraph
