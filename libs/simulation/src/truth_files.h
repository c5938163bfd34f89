// SPDX-License-Identifier: BSD-3-Clause
// Writers of the ground-truth files of a simulation.
#pragma once

#include <filesystem>

#include "id_raster.h"
#include "roomgraph/core/output_file.h"
#include "scene.h"
#include "sensors.h"

namespace roomgraph {

class TruthFile : public OutputFile {
 public:
  using OutputFile::OutputFile;
  /// printf-like line.
  void line(const char* format, ...) __attribute__((format(printf, 2, 3)));
};

/// One line "t tx ty tz qx qy qz qw".
void writePose(TruthFile& file, double t, const Pose3& pose);
/// One line of boxes.jsonl.
void writeBoxes(TruthFile& file, int frame, double t, const std::vector<ObjectView>& views,
                const Scene& scene);
/// With furniture where it stands after so many seconds.
void writeObjects(const std::filesystem::path& file, const Scene& scene, double seconds);
void writeCalibration(const std::filesystem::path& file, const World& world, const Scene& scene);
/// A picture and its yaml: outlines at the lidar's height occupied, what can be reached from the start free.
void writeMapTruth(const std::filesystem::path& pgm, const std::filesystem::path& yaml,
                   const std::vector<Segment>& outlines);

}  // namespace roomgraph
