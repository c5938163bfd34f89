// SPDX-License-Identifier: BSD-3-Clause
// Detections as rawlog records and back; hash of weights files.
#pragma once

#include <string>
#include <vector>

#include "roomgraph/detection/detector.h"

namespace roomgraph {

/// The detections of a frame as a record of a rawlog: replayed with RecordedDetector it gives the
/// same detections, bit for bit. Boxes that were carried to this frame are left out: the replay carries them, too.
CObservationDetections toRecord(const Frame& frame, const std::vector<Detection>& detections,
                                const DetectorIdentity& identity, const std::vector<std::string>& unsought = {});
/// The boxes of a record; class_name is empty: it follows from the label and the object database.
std::vector<Detection> detectionsOf(const CObservationDetections& record);

/// 64-bit FNV-1a hash of a file's bytes as 16 hexadecimal digits. Throws InputError when it cannot be read.
std::string fileHash(const std::string& file);

}  // namespace roomgraph
