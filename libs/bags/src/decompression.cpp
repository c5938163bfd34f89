// SPDX-License-Identifier: BSD-3-Clause
// Decompression with bzip2, LZ4 and Zstandard into memory that grows with what comes.
#include "decompression.h"

#include <bzlib.h>
#include <lz4frame.h>
#include <zstd.h>

#include <algorithm>
#include <memory>
#include <new>

namespace roomgraph::bags {
namespace {

constexpr std::size_t kStepBytes = 1u << 20;

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

void decompressZstd(Bytes bytes, std::size_t size, std::vector<std::uint8_t>& out) {
  const std::unique_ptr<ZSTD_DStream, std::size_t (*)(ZSTD_DStream*)> stream(ZSTD_createDStream(),
                                                                             ZSTD_freeDStream);
  if (!stream) throw std::bad_alloc();
  ZSTD_inBuffer in{bytes.data(), bytes.size(), 0};
  std::size_t used = 0;
  while (used < size) {
    const auto room = roomBehind(out, used, size);
    ZSTD_outBuffer got{room.data(), room.size(), 0};
    const std::size_t taken = in.pos, state = ZSTD_decompressStream(stream.get(), &got, &in);
    if (ZSTD_isError(state)) break;
    used += got.pos;
    if (got.pos == 0 && in.pos == taken) break;
  }
  out.resize(used);
}

}  // namespace

void decompress(const std::string& compression, Bytes bytes, std::size_t size,
                std::vector<std::uint8_t>& out) {
  out.clear();
  if (compression == "bz2")
    decompressBzip2(bytes, size, out);
  else if (compression == "lz4")
    decompressLz4(bytes, size, out);
  else if (compression == "zstd")
    decompressZstd(bytes, size, out);
  else
    throw BadMessage("compression '" + compression + "' is not known");
  if (out.size() < size) throw BadMessage("compressed data are damaged");
}

}  // namespace roomgraph::bags
