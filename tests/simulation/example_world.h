// SPDX-License-Identifier: BSD-3-Clause
// World of one room for the simulation tests, as JSON text.
#pragma once

#include <string>

#include "roomgraph/simulation/world_file.h"

namespace roomgraph::test {

/// A room of 6 x 4 m; the robot drives along x from (1, 2) to (3, 2), so world = plan moved by (-1, -2).
inline std::string exampleWorldText() {
  return R"({
  "name": "example",
  "rooms": [{"corner_m": [0, 0], "size_m": [6, 4], "wall": {"pattern": "paint", "color": "#ffffff"},
             "doorways": [{"side": "north", "at_m": 5, "door": "closed"}]}],
  "furniture": [{"model": "block", "at_m": [4.5, 2.5], "size_m": [0.6, 0.4, 1.0], "color": "#000000"}],
  "people": [{"path_m": [[1, 3.4], [3, 3.4]]}],
  "robot": {"path_m": [[1, 2], [2, 2], [3, 2]]},
  "sensors": {"camera": {"preset": "kinect", "pitch_down_deg": 0}, "lidar": {"preset": "rplidar"},
              "odometry": {"preset": "kobuki"}}
})";
}

inline World exampleWorld() {
  return parseWorld(exampleWorldText(), "example.json");
}

/// The example with `from` replaced by `to`.
inline std::string changed(const std::string& from, const std::string& to) {
  std::string text = exampleWorldText();
  text.replace(text.find(from), from.size(), to);
  return text;
}

}  // namespace roomgraph::test
