// SPDX-License-Identifier: BSD-3-Clause
// A rawlog whose boxes are records of their own class.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>

namespace roomgraph {

struct DetectionRecords {
  std::size_t records = 0, detections = 0;  ///< written; of these, with boxes
  std::size_t damaged = 0;  ///< comments with detections that cannot be read: copied as they are
};

/// Writes a copy of a rawlog in which comments that hold detections are records of the class
/// CObservationDetections: MRPT's programs, with our library loaded, describe, draw and export these. All
/// else is copied byte by byte. `progress` gets the share that is done. Throws InputError (input),
/// ConfigError (the output is the input), RunError (output).
DetectionRecords exportDetectionRecords(const std::filesystem::path& input,
                                        const std::filesystem::path& output,
                                        const std::function<void(double)>& progress = {});

}  // namespace roomgraph
