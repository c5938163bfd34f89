// SPDX-License-Identifier: BSD-3-Clause
// One short write at the file's beginning for each update.
#include "roomgraph/core/progress_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <fstream>

namespace roomgraph {

ProgressFile::ProgressFile(const std::filesystem::path& file) {
  if (file.empty()) return;
  descriptor_ = open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  write(0);
}

ProgressFile::~ProgressFile() {
  if (descriptor_ >= 0) close(descriptor_);
}

void ProgressFile::write(double share) const {
  char text[16];
  const int length = std::snprintf(text, sizeof text, "%.4f\n", std::clamp(share, 0.0, 1.0));
  if (descriptor_ >= 0 && pwrite(descriptor_, text, static_cast<std::size_t>(length), 0) != length) return;
}

void ProgressFile::update(double share) {
  const auto now = std::chrono::steady_clock::now();
  if (descriptor_ < 0 || now - last_ < std::chrono::milliseconds(200)) return;
  last_ = now;
  write(share);
}

std::optional<double> readProgress(const std::filesystem::path& file) {
  std::ifstream in(file);
  double share = 0;
  if (!(in >> share) || share < 0 || share > 1) return std::nullopt;
  return share;
}

}  // namespace roomgraph
