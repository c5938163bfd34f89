// SPDX-License-Identifier: BSD-3-Clause
// Sound small inputs for each target, from which fuzzing starts.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace roomgraph::fuzz {

/// Writes seeds as DIR/TARGET/NAME.
class Corpus {
 public:
  explicit Corpus(std::filesystem::path folder) : folder_(std::move(folder)) {}

  void add(const std::string& target, const std::string& name, std::string_view bytes);
  /// Files of one input as its parts (writeParts() in target.h).
  void add(const std::string& target, const std::string& name, const std::vector<std::string>& parts);
  int written() const { return written_; }

 private:
  std::filesystem::path folder_;
  int written_ = 0;
};

void addRawlogs(Corpus& corpus);
void addMaps(Corpus& corpus);
void addSettings(Corpus& corpus);
void addResults(Corpus& corpus);
void addCheckpoints(Corpus& corpus);
void addNetworks(Corpus& corpus);
void addFolders(Corpus& corpus);
/// Bags of ROS 1 need Debian's rosbag and are left out without it.
void addBags(Corpus& corpus);

}  // namespace roomgraph::fuzz
