// SPDX-License-Identifier: BSD-3-Clause
// Flags of records out of damaged files, brought back to true or false.
#pragma once

#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/serialization/CSerializable.h>

namespace roomgraph {

/// MRPT reads a flag as one byte, whatever its value, and using a bool that is neither 0 nor 1 is undefined behaviour.
/// Makes every such flag of an image or scan, also within a sensory frame, true. To be called before anything looks at them.
void repairFlags(mrpt::serialization::CSerializable& record);

/// Whether the range image is in a file of its own. Told by the file's name, as MRPT's own flag for it cannot be repaired.
bool rangeImageIsInAFile(const mrpt::obs::CObservation3DRangeScan& images);

}  // namespace roomgraph
