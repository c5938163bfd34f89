// SPDX-License-Identifier: BSD-3-Clause
// Sub-commands about ROS bags, and the progress line that conversions share.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <memory>
#include <string>

namespace roomgraph {

/// `import rosbag` and `import rosbag2`.
void addImportBag(CLI::App& importer);

/// A progress line by the share done, on stderr. Throws Interrupted, saying that `output` was not written,
/// when the user wants an end.
class ShareProgress {
 public:
  ShareProgress(const std::string& label, std::string output);
  ~ShareProgress();
  ShareProgress(const ShareProgress&) = delete;
  ShareProgress& operator=(const ShareProgress&) = delete;
  /// For libraries; refers to this object.
  std::function<void(double)> function();
  void finish();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace roomgraph
