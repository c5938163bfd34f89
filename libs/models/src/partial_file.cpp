// SPDX-License-Identifier: BSD-3-Clause
// Appending, emptying and renaming of a partial file.
#include "partial_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>

#include "roomgraph/core/errors.h"
#include "roomgraph/core/output_file.h"

namespace roomgraph {

namespace fs = std::filesystem;

fs::path PartialFile::nameFor(const fs::path& place) {
  return fs::path(place) += ".part";
}

PartialFile::PartialFile(const fs::path& place) : place_(place), path_(nameFor(place)) {
  descriptor_ = open(path_.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
  if (descriptor_ < 0) failToWrite(path_, errno);
  struct stat state {};
  if (fstat(descriptor_, &state) == 0) bytes_ = static_cast<std::uint64_t>(state.st_size);
}

PartialFile::~PartialFile() {
  std::error_code ignored;
  if (bytes_ == 0) fs::remove(path_, ignored);
  if (descriptor_ >= 0) close(descriptor_);
}

void PartialFile::append(std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = write(descriptor_, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) failToWrite(path_, errno);
    bytes_ += static_cast<std::uint64_t>(written);
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
}

void PartialFile::clear() {
  if (ftruncate(descriptor_, 0) != 0) failToWrite(path_, errno);
  bytes_ = 0;
}

void PartialFile::commit() {
  if (fsync(descriptor_) != 0 && errno != EINVAL && errno != EROFS) failToWrite(path_, errno);
  std::error_code error;
  fs::rename(path_, place_, error);
  if (error) throw RunError("cannot write " + place_.string() + ": " + error.message());
  const int folder = open(place_.parent_path().c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (folder < 0) return;
  fsync(folder);  // the name, too, outlives a loss of power
  close(folder);
}

}  // namespace roomgraph
