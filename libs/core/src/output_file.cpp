// SPDX-License-Identifier: BSD-3-Clause
// Atomic file replacement by a locked temporary file and rename; messages from errno.
#include "roomgraph/core/output_file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "roomgraph/core/errors.h"

namespace roomgraph {
namespace {

namespace fs = std::filesystem;

// A symbolic link is kept: the file that it names is replaced.
fs::path behindLinks(const fs::path& file) {
  std::error_code error;
  const fs::path target = fs::is_symlink(file, error) ? fs::canonical(file, error) : file;
  return error ? file : target;
}

void writeBytes(const fs::path& file, std::string_view bytes) {
  OutputFile out(file);
  out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  out.finish();
}

}  // namespace

void failToWrite(const fs::path& file, int error) {
  throw RunError("cannot write " + file.string() + ": " + std::strerror(error ? error : EIO));
}

OutputFile::OutputFile(fs::path file) : file_(std::move(file)) {
  errno = 0;
  open(file_, std::ios::binary);
  check();
}

void OutputFile::check() {
  if (fail()) failToWrite(file_, errno);
}

void OutputFile::finish() {
  check();  // before errno is forgotten
  errno = 0;
  flush();
  check();
  close();
  check();
}

PendingFile::PendingFile(const fs::path& place) : place_(behindLinks(place)), temporary_(place_) {
  std::error_code ignored;
  if (fs::exists(place_, ignored) && !fs::is_regular_file(place_, ignored))
    throw RunError("cannot write " + place.string() + ": is not a file");
  temporary_ += ".unfinished";
  lock_ = open(temporary_.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0666);
  if (lock_ < 0) failToWrite(place, errno);
  if (flock(lock_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
    close(lock_);
    throw RunError(place.string() + ": another process is writing it");
  }
}

PendingFile::~PendingFile() {
  std::error_code ignored;
  if (!temporary_.empty()) fs::remove(temporary_, ignored);
  close(lock_);
}

void PendingFile::commit() {
  flushToDisk(temporary_);
  std::error_code error;
  fs::rename(temporary_, place_, error);
  if (error) throw RunError("cannot write " + place_.string() + ": " + error.message());
  temporary_.clear();
}

void writeFileAtomically(const fs::path& file, std::string_view bytes) {
  std::error_code ignored;
  if (fs::exists(file, ignored) && !fs::is_regular_file(file, ignored)) return writeBytes(file, bytes);
  PendingFile pending(file);
  writeBytes(pending.path(), bytes);
  pending.commit();
}

void requireOther(const fs::path& output, const std::vector<fs::path>& inputs) {
  std::error_code none;
  for (const auto& input : inputs)
    if (fs::equivalent(output, input, none))
      throw ConfigError(output.string() + ": is read by this command; write to another file");
}

void flushToDisk(const fs::path& file) {
  const int descriptor = open(file.c_str(), O_WRONLY | O_CLOEXEC);
  const bool failed = descriptor < 0 || (fsync(descriptor) != 0 && errno != EINVAL && errno != EROFS);
  const int error = errno;
  if (descriptor >= 0) close(descriptor);
  if (failed) failToWrite(file, error);
}

}  // namespace roomgraph
