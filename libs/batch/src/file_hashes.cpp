// SPDX-License-Identifier: BSD-3-Clause
// Cache of checksums by path, size and time.
#include "file_hashes.h"

#include <algorithm>

#include "roomgraph/core/checksum.h"
#include "truth_files.h"

namespace roomgraph {

bool FileHashes::knows(const std::filesystem::path& file) {
  const std::string stamp = stampOf(file);
  auto& known = known_[file.string()];
  if (stamp.empty() || known.first == stamp) return !stamp.empty();
  const auto hash = catalogue_ ? catalogue_->checksum(file, stamp) : std::nullopt;
  if (hash) known = {stamp, *hash};
  return hash.has_value();
}

void FileHashes::remember(const std::filesystem::path& file, const std::string& sha256) {
  const std::string stamp = stampOf(file);
  known_[file.string()] = {stamp, sha256};
  if (memory_ && !stamp.empty()) memory_->rememberChecksum(file, stamp, sha256);
}

std::string FileHashes::of(const std::filesystem::path& file) {
  if (!knows(file)) remember(file, sha256OfFile(file));
  return known_[file.string()].second;
}

std::string FileHashes::of(const std::vector<std::filesystem::path>& files) {
  std::string text;
  for (const auto& file : files) text += file.filename().string() + " " + of(file) + "\n";
  return sha256Of(text);
}

std::string FileHashes::ofRecording(const std::filesystem::path& rawlog) {
  const std::string hash = of(rawlog);
  const auto images = rawlog.parent_path() / (recordingName(rawlog) + "_Images");
  std::vector<std::string> lines;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(images, error))
    if (entry.is_regular_file(error))
      lines.push_back(entry.path().filename().string() + " " + std::to_string(entry.file_size(error)) + "\n");
  if (lines.empty()) return hash;
  std::sort(lines.begin(), lines.end());
  std::string text = hash + "\n";
  for (const auto& line : lines) text += line;
  return sha256Of(text);
}

}  // namespace roomgraph
