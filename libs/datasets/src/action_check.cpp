// SPDX-License-Identifier: BSD-3-Clause
// Class and version check of movement distributions in the bytes of an action record.
#include "action_check.h"

#include <mrpt/poses/CPosePDF.h>

#include <cstdint>
#include <cstring>
#include <string>

namespace roomgraph {
namespace {

// An object of MRPT's begins with the length of its class' name (with the highest bit), and the name.
bool isDistribution(std::string_view object) {
  constexpr std::uint8_t kLength = 0x7f;
  if (object.empty()) return false;
  const std::string name(object.substr(1, static_cast<std::uint8_t>(object[0]) & kLength));
  const auto* id = mrpt::rtti::findRegisteredClass(name);
  return id && id->ptrCreateObject && id->derivedFrom(CLASS_ID(mrpt::poses::CPosePDF));
}

// Behind the name: version, then (since version 2) how the movement was estimated, and unless that is wheel
// odometry the distribution.
bool canBeParsed(std::string_view movement) {
  constexpr std::int32_t kByOdometry = 0;
  std::int32_t method = kByOdometry;
  if (movement.size() < 1 + sizeof method) return false;
  if (movement[0] < 2) return isDistribution(movement.substr(1));
  std::memcpy(&method, movement.data() + 1, sizeof method);
  return method == kByOdometry || isDistribution(movement.substr(1 + sizeof method));
}

}  // namespace

bool movementsCanBeParsed(std::string_view record) {
  constexpr std::string_view kName = "CActionRobotMovement2D";
  for (auto at = record.find(kName); at != record.npos; at = record.find(kName, at + kName.size()))
    if (!canBeParsed(record.substr(at + kName.size()))) return false;
  return true;
}

}  // namespace roomgraph
