// SPDX-License-Identifier: BSD-3-Clause
// Positioned reads into one buffer.
#include "file_window.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>

#include "roomgraph/core/errors.h"

namespace roomgraph::bags {
namespace {

constexpr std::size_t kBufferBytes = 256u << 10;

}  // namespace

FileWindow::FileWindow(const std::filesystem::path& file) : file_(file) {
  std::error_code error;
  size_ = std::filesystem::file_size(file, error);
  if (!error) descriptor_ = open(file.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor_ < 0)
    throw InputError(file.string() + ": cannot be opened: " +
                     (error ? error : std::error_code(errno, std::generic_category())).message());
}

FileWindow::~FileWindow() {
  close(descriptor_);
}

Bytes FileWindow::at(std::uint64_t offset, std::size_t count) {
  if (offset >= size_) return {};
  count = static_cast<std::size_t>(std::min<std::uint64_t>(count, size_ - offset));
  if (offset < begin_ || offset + count > begin_ + filled_) {
    if (buffer_.size() < std::max(count, kBufferBytes)) buffer_.resize(std::max(count, kBufferBytes));
    begin_ = offset;
    filled_ = 0;
    // No further than what is asked for needs: most of a bag is images that are stepped over.
    const std::size_t wanted = std::max(count, std::min(kBufferBytes / 16, buffer_.size()));
    while (filled_ < wanted) {
      const auto got = pread(descriptor_, buffer_.data() + filled_, wanted - filled_,
                             static_cast<off_t>(offset + filled_));
      if (got < 0 && errno == EINTR) continue;
      if (got < 0)
        throw InputError(file_.string() +
                         ": reading failed: " + std::error_code(errno, std::generic_category()).message());
      if (got == 0) break;
      filled_ += static_cast<std::size_t>(got);
    }
  }
  const std::size_t skip = static_cast<std::size_t>(offset - begin_);
  return Bytes(buffer_).subspan(skip, std::min(count, filled_ - std::min(skip, filled_)));
}

}  // namespace roomgraph::bags
