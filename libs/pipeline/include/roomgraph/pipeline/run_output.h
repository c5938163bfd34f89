// SPDX-License-Identifier: BSD-3-Clause
// Part of roomgraph, object-level semantic SLAM.
#pragma once

#include <filesystem>
#include <fstream>
#include <map>
#include <string>

#include "roomgraph/pipeline/semantic_slam.h"

namespace roomgraph {

/// Writes a run's files (docs/formats.md). What is known live goes to disk as it comes, the rest at the end,
/// so a run that is interrupted leaves valid files.
class RunOutput : public Sink {
 public:
  /// Makes the folder. Throws RunError when it cannot be written.
  explicit RunOutput(const std::filesystem::path& folder);

  void onStep(const StepReport& report) override;

  /// Final files: trajectories, landmarks, occupancy, map, graph, effective config, summary.
  void writeResult(const SemanticSlam& slam, const SlamResult& result, const ReadStatistics& read,
                   const std::map<std::string, std::string>& facts);

  const std::filesystem::path& folder() const { return folder_; }

 private:
  std::ofstream open(const std::string& name) const;

  std::filesystem::path folder_;
  std::ofstream live_, detections_, associations_;
};

/// "t tx ty tz qx qy qz qw" lines.
void writeTum(std::ostream& out, const std::vector<StampedPose>& poses);

}  // namespace roomgraph
