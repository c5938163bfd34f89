// SPDX-License-Identifier: BSD-3-Clause
// Check that the movements in a serialised action record can be parsed by MRPT.
#pragma once

#include <string_view>

namespace roomgraph {

/// Whether MRPT can parse the movements in the bytes of an action record: it uses the distribution of a
/// CActionRobotMovement2D without looking whether what stands in its place is one.
bool movementsCanBeParsed(std::string_view record);

}  // namespace roomgraph
