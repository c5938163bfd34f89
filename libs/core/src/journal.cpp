// SPDX-License-Identifier: BSD-3-Clause
// Records as length, chained checksum and bytes; a record that cannot be written is taken back.
#include "roomgraph/core/journal.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

#include "roomgraph/core/checksum.h"
#include "roomgraph/core/errors.h"
#include "roomgraph/core/output_file.h"

namespace roomgraph {
namespace {

constexpr std::string_view kTitle = "roomgraph journal 1\n";
constexpr std::size_t kLengthBytes = 8, kChecksumBytes = 16, kHeadBytes = kLengthBytes + kChecksumBytes;

// Little endian, whatever the machine.
std::string lengthText(std::uint64_t length) {
  std::string bytes;
  for (std::size_t i = 0; i < kLengthBytes; ++i) bytes += static_cast<char>(length >> (8 * i) & 0xff);
  return bytes;
}

std::uint64_t lengthOf(std::string_view bytes) {
  std::uint64_t length = 0;
  for (std::size_t i = kLengthBytes; i-- > 0;) length = length << 8 | static_cast<unsigned char>(bytes[i]);
  return length;
}

// A file that is on the disk, but not in its folder there, is lost with the power. Not every file system can
// do it.
void flushNameOf(const std::filesystem::path& file) {
  const int folder = open(file.parent_path().c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (folder < 0) return;
  fsync(folder);
  close(folder);
}

}  // namespace

Journal::Journal(std::filesystem::path file, std::string_view key)
    : file_(std::move(file)), last_(sha256Of(key).substr(0, kChecksumBytes)) {
  descriptor_ = open(file_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  struct stat state {};
  if (descriptor_ < 0 || fstat(descriptor_, &state) != 0) failToWrite(file_, errno);
  size_ = static_cast<std::uintmax_t>(state.st_size);
  if (size_ == 0) flushNameOf(file_);
  std::string title(kTitle.size(), '\0');
  if (read(0, title.data(), title.size()) && title == kTitle) end_ = kTitle.size();
}

Journal::~Journal() {
  if (descriptor_ >= 0) close(descriptor_);
}

std::string Journal::checksumOf(std::string_view record) const {
  return sha256Of(last_ + lengthText(record.size()) + std::string(record)).substr(0, kChecksumBytes);
}

bool Journal::read(std::uintmax_t from, char* out, std::size_t count) const {
  if (count > size_ || from > size_ - count) return false;
  while (count > 0) {
    const ssize_t got = pread(descriptor_, out, count, static_cast<off_t>(from));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) throw RunError(file_.string() + ": read error: " + std::strerror(errno));
    if (got == 0) return false;
    out += got;
    from += static_cast<std::uintmax_t>(got);
    count -= static_cast<std::size_t>(got);
  }
  return true;
}

std::optional<std::string> Journal::next() {
  std::string head(kHeadBytes, '\0');
  if (end_ == 0 || !read(end_, head.data(), head.size())) return std::nullopt;
  const std::uint64_t length = lengthOf(head);
  if (length > size_ - end_ - kHeadBytes) return std::nullopt;
  std::string record(length, '\0');
  if (!read(end_ + kHeadBytes, record.data(), record.size())) return std::nullopt;
  std::string checksum = checksumOf(record);
  if (head.compare(kLengthBytes, kChecksumBytes, checksum) != 0) return std::nullopt;
  last_before_ = std::exchange(last_, std::move(checksum));
  end_before_ = std::exchange(end_, end_ + kHeadBytes + length);
  return record;
}

void Journal::unread() {
  last_ = last_before_;
  end_ = end_before_;
}

void Journal::write(std::string_view bytes) {
  for (std::uintmax_t at = end_; !bytes.empty();) {
    const ssize_t written = pwrite(descriptor_, bytes.data(), bytes.size(), static_cast<off_t>(at));
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) {
      const int error = written < 0 ? errno : ENOSPC;
      // Half a record is of no use, and its bytes may be what others need.
      if (ftruncate(descriptor_, static_cast<off_t>(end_)) == 0) size_ = end_;
      failToWrite(file_, error);
    }
    at += static_cast<std::uintmax_t>(written);
    bytes.remove_prefix(static_cast<std::size_t>(written));
    size_ = std::max(size_, at);
  }
}

void Journal::append(std::string_view record) {
  if (size_ > end_) {
    if (ftruncate(descriptor_, static_cast<off_t>(end_)) != 0) failToWrite(file_, errno);
    size_ = end_;
  }
  if (end_ == 0) {
    write(kTitle);
    end_ = kTitle.size();
  }
  std::string checksum = checksumOf(record);
  write(lengthText(record.size()) + checksum + std::string(record));
  last_ = std::move(checksum);
  end_ = size_;
}

void Journal::sync() {
  if (fdatasync(descriptor_) != 0 && errno != EINVAL && errno != EROFS) failToWrite(file_, errno);
}

}  // namespace roomgraph
