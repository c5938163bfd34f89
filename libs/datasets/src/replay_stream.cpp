// SPDX-License-Identifier: BSD-3-Clause
// Buffered zlib reading with rewind, and detection of truncated data.
#include "replay_stream.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <limits>

#include "roomgraph/core/allocation_limit.h"
#include "roomgraph/core/errors.h"

namespace roomgraph {
namespace {

// Small, because zlib drops what it has of a call when it meets broken data.
constexpr std::size_t kChunkBytes = 32 * 1024;
// A damaged length field must not make the program read the rest of the file into memory.
constexpr std::size_t kLongestUnreadBytes = 128u << 20;
constexpr std::size_t kForgetBytes = 4u << 20;

}  // namespace

ReplayStream::ReplayStream(const std::filesystem::path& file) : name_(file.string()) {
  std::error_code error;
  if (!std::filesystem::exists(file, error)) throw InputError(file.string() + ": no such file");
  if (std::filesystem::is_directory(file, error))
    throw InputError(file.string() + ": is a directory, not a rawlog");
  if (!std::filesystem::is_regular_file(file, error))
    throw InputError(file.string() + ": is a pipe or device; a rawlog is read from a file");
  file_.reset(gzopen(file.c_str(), "rb"));
  if (!file_) throw InputError(file.string() + ": cannot be opened: " + std::strerror(errno));
  file_size_ = std::filesystem::file_size(file, error);
  if (error) file_size_ = 0;
  gzbuffer(file_.get(), 4 * kChunkBytes);
  if (atEnd())
    throw InputError(file.string() + ": " + (damage_.empty() ? "is empty" : "not a rawlog: " + damage_));
}

std::uint64_t ReplayStream::filePosition() const {
  const auto offset = gzoffset(file_.get());
  return offset < 0 ? 0 : static_cast<std::uint64_t>(offset);
}

void ReplayStream::mark() {
  met_end_ = false;
  if (cursor_ < kForgetBytes && cursor_ < bytes_.size()) return;
  bytes_.erase(bytes_.begin(), bytes_.begin() + static_cast<std::ptrdiff_t>(cursor_));
  base_ += cursor_;
  cursor_ = 0;
}

// zlib goes on to say so whenever it is asked again; the cause is only known the first time.
void ReplayStream::failToRead(int error) {
  if (read_error_.empty())
    read_error_ =
        name_ + ": read error behind byte " + std::to_string(filePosition()) + ": " + std::strerror(error);
  throw RunError(read_error_);
}

bool ReplayStream::fetch() {
  if (ended_ || bytes_.size() > kLongestUnreadBytes) return false;
  const AllocationLimit unlimited(
      std::numeric_limits<std::size_t>::max());  // the limit is for what is parsed
  const std::size_t before = bytes_.size();
  bytes_.resize(before + kChunkBytes);
  const int got = gzread(file_.get(), bytes_.data() + before, kChunkBytes);
  const int error = errno;
  bytes_.resize(before + static_cast<std::size_t>(std::max(got, 0)));
  if (got < static_cast<int>(kChunkBytes)) {
    int code = Z_OK;
    const char* message = gzerror(file_.get(), &code);
    if (code == Z_BUF_ERROR)
      damage_ = "the gzip stream is cut off";
    else if (code == Z_ERRNO)
      failToRead(error);
    else if (code != Z_OK)
      damage_ = std::string("the gzip stream is damaged (") + message + ")";
    ended_ = got <= 0 || code != Z_OK || gzeof(file_.get());
  }
  return bytes_.size() > before;
}

const std::uint8_t* ReplayStream::peek(std::uint64_t position, std::size_t count) {
  const std::size_t first = static_cast<std::size_t>(position - base_);
  while (bytes_.size() < first + count)
    if (!fetch()) return nullptr;
  return bytes_.data() + first;
}

std::size_t ReplayStream::read(void* out, std::size_t count) {
  if (count == 0) return 0;
  const std::uint8_t* from = peek(position(), count);
  if (!from) {
    met_end_ = true;
    cursor_ = bytes_.size();
    return 0;
  }
  std::memcpy(out, from, count);
  cursor_ += count;
  return count;
}

std::size_t ReplayStream::write(const void*, std::size_t) {
  throw std::logic_error("ReplayStream is for reading");
}

}  // namespace roomgraph
