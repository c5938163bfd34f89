// SPDX-License-Identifier: BSD-3-Clause
// Buffered file access, header fields, and decompression with bzip2 and LZ4.
#include "ros1_records.h"

#include <bzlib.h>
#include <fcntl.h>
#include <lz4frame.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <memory>

#include "roomgraph/core/errors.h"

namespace roomgraph::bags {
namespace {

constexpr std::size_t kBufferBytes = 256u << 10, kStepBytes = 1u << 20;

// Room for the next bytes of a growing output, never beyond its final size.
std::span<std::uint8_t> roomBehind(std::vector<std::uint8_t>& out, std::size_t used, std::size_t size) {
  if (used == out.size()) out.resize(std::min(size, std::max(out.size() + kStepBytes, 2 * out.size())));
  return std::span(out).subspan(used);
}

void decompressBzip2(Bytes bytes, std::size_t size, std::vector<std::uint8_t>& out) {
  bz_stream stream{};
  if (BZ2_bzDecompressInit(&stream, 0, 0) != BZ_OK) throw std::bad_alloc();
  const std::unique_ptr<bz_stream, int (*)(bz_stream*)> guard(&stream, BZ2_bzDecompressEnd);
  stream.next_in = reinterpret_cast<char*>(const_cast<std::uint8_t*>(bytes.data()));
  stream.avail_in = static_cast<unsigned>(bytes.size());
  std::size_t used = 0;
  for (int state = BZ_OK; used < size && state == BZ_OK;) {
    const auto room = roomBehind(out, used, size);
    stream.next_out = reinterpret_cast<char*>(room.data());
    stream.avail_out = static_cast<unsigned>(room.size());
    state = BZ2_bzDecompress(&stream);
    const std::size_t got = room.size() - stream.avail_out;
    used += got;
    if (got == 0 && stream.avail_in == 0) break;
  }
  out.resize(used);
}

void decompressLz4(Bytes bytes, std::size_t size, std::vector<std::uint8_t>& out) {
  LZ4F_dctx* context = nullptr;
  if (LZ4F_isError(LZ4F_createDecompressionContext(&context, LZ4F_VERSION))) throw std::bad_alloc();
  const std::unique_ptr<LZ4F_dctx, LZ4F_errorCode_t (*)(LZ4F_dctx*)> guard(context,
                                                                           LZ4F_freeDecompressionContext);
  std::size_t used = 0;
  while (used < size) {
    const auto room = roomBehind(out, used, size);
    std::size_t got = room.size(), taken = bytes.size();
    const std::size_t state = LZ4F_decompress(context, room.data(), &got, bytes.data(), &taken, nullptr);
    if (LZ4F_isError(state)) break;
    used += got;
    bytes = bytes.subspan(taken);
    if (state == 0 || (got == 0 && taken == 0)) break;
  }
  out.resize(used);
}

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

std::optional<RecordFields> parseFields(Bytes bytes) {
  RecordFields fields;
  try {
    for (Ros1Reader in(bytes); in.left() > 0;) {
      const std::string field = in.text();
      const auto equals = field.find('=');
      if (equals == std::string::npos) return std::nullopt;
      fields[field.substr(0, equals)] = field.substr(equals + 1);
    }
  } catch (const BadMessage&) {
    return std::nullopt;
  }
  return fields;
}

void decompress(const std::string& compression, Bytes bytes, std::size_t size,
                std::vector<std::uint8_t>& out) {
  out.clear();
  if (compression == "bz2")
    decompressBzip2(bytes, size, out);
  else if (compression == "lz4")
    decompressLz4(bytes, size, out);
  else
    throw BadMessage("compression '" + compression + "' is not known");
  if (out.size() < size) throw BadMessage("compressed data are damaged");
}

}  // namespace roomgraph::bags
