// SPDX-License-Identifier: BSD-3-Clause
// Faults put into a rawlog: sensors that fail, freeze, lie or lose their clock.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace roomgraph {

/// A kind of fault, as a command line names it.
struct FaultKind {
  std::string name;   ///< "drop-camera"
  std::string value;  ///< pattern of its value: "A:B"
  std::string what;   ///< what it does, in words
};
const std::vector<FaultKind>& faultKinds();

/// A fault that is wanted.
struct FaultRequest {
  std::string kind, value;  ///< "drop-camera", "10:20"
};

/// What a fault did.
struct FaultEffect {
  std::string fault;                  ///< "--drop-camera 10:20"
  std::map<std::string, int> counts;  ///< records by sensor label: removed, doubled, moved or changed
};

struct DamageResult {
  std::vector<FaultEffect> effects;    ///< in the order of the requests
  int read = 0, written = 0;           ///< observations
  double duration_s = 0;               ///< of the input: from its first stamp to its latest
  std::map<std::string, int> skipped;  ///< broken records of the input, by reason: not in the output
  std::string truncation;              ///< of an input that is cut off: where; else empty
};

/// Copies the observations of a rawlog through the faults, each of which gets what the one before it left.
/// Times A and B in a request's value are seconds after the first stamp of the input, whatever other faults
/// do to stamps; a window A:B has A and not B. "SENSOR" in it is camera (RGB-D records and recorded
/// detections), lidar or odometry. Records that no fault touches keep their bytes; pictures that are made
/// anew are stored without loss. The output is observation-only (actions become odometry readings) and has no
/// images in files; it gets its name when it is whole. Same input, requests and seed: same bytes. `progress`
/// gets the share done and may throw to end it.
///
/// Throws ConfigError (no request, unknown kind, bad value, a fault that touches no record, output is the
/// input), InputError (input cannot be read) or RunError (output cannot be written).
DamageResult damageRawlog(const std::filesystem::path& input, const std::filesystem::path& output,
                          const std::vector<FaultRequest>& requests, std::uint64_t seed,
                          const std::function<void(double share)>& progress = nullptr);

}  // namespace roomgraph
