// SPDX-License-Identifier: BSD-3-Clause
// map.rgmap: gzipped MRPT archive with a checksum, read with bounded memory.
#include <mrpt/io/CFileGZInputStream.h>
#include <mrpt/io/CMemoryStream.h>
#include <mrpt/serialization/CArchive.h>
#include <zlib.h>

#include <new>
#include <stdexcept>

#include "map_check.h"
#include "roomgraph/core/allocation_limit.h"
#include "roomgraph/core/checksum.h"
#include "roomgraph/core/error_text.h"
#include "roomgraph/core/errors.h"
#include "roomgraph/core/output_file.h"
#include "roomgraph/observations/map_file.h"
#include "roomgraph/observations/register_classes.h"

namespace roomgraph {
namespace {

constexpr std::size_t kLargestBytes = 512u << 20;  // the largest grid of a run, 4e8 cells, and 110 MB for the rest
// What follows the archive: this mark and the SHA-256 of all before it.
constexpr std::string_view kSumMark = "roomgraph map sha256 ";
constexpr std::size_t kSumDigits = 64;
constexpr std::size_t kSpareBytes = 1u << 20, kBytesPerByte = 4;

std::vector<std::uint8_t> inflated(const std::filesystem::path& file) {
  mrpt::io::CFileGZInputStream in;
  if (!in.open(file.string())) throw InputError(file.string() + ": cannot be opened");
  constexpr std::size_t kChunk = 1u << 20;
  std::vector<std::uint8_t> bytes;
  for (std::size_t got = kChunk; got == kChunk && bytes.size() < kLargestBytes;) {
    const std::size_t before = bytes.size();
    bytes.resize(before + kChunk);
    got = in.Read(bytes.data() + before, kChunk);
    if (got > kChunk) got = 0;  // -1: damaged; the reader of the archive reports it
    bytes.resize(before + got);
  }
  return bytes;
}

mrpt::serialization::CSerializable::Ptr parsed(const std::vector<std::uint8_t>& bytes,
                                               const std::filesystem::path& file) {
  mrpt::io::CMemoryStream in;
  in.assignMemoryNotOwn(bytes.data(), bytes.size());
  try {
    const AllocationLimit limit(kSpareBytes + kBytesPerByte * bytes.size());
    return mrpt::serialization::archiveFrom(in).ReadObject();
  } catch (const std::bad_alloc&) {
    throw InputError(file.string() +
                     ": not a roomgraph map, or damaged (a size in it is larger than the file)");
  } catch (const std::exception& error) {
    const std::string what = firstLine(error);
    if (what.find("version") != std::string::npos)
      throw InputError(file.string() + ": was written by a newer version of roomgraph (" + what + ")");
    if (what.find("EOF") != std::string::npos)
      throw InputError(file.string() +
                       ": not a roomgraph map, or damaged (it is cut off, or a size in it is larger than the file)");
    throw InputError(file.string() + ": not a roomgraph map, or damaged (" + what + ")");
  }
}

// Whether the bytes end with their checksum, which is taken off; maps of version 0 have none.
bool takeChecksum(std::vector<std::uint8_t>& bytes, const std::filesystem::path& file) {
  const std::size_t length = kSumMark.size() + kSumDigits;
  if (bytes.size() < length) return false;
  const std::string_view all(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  const auto content = all.substr(0, all.size() - length), end = all.substr(content.size());
  if (!end.starts_with(kSumMark)) return false;
  if (sha256Of(content) != end.substr(kSumMark.size()))
    throw InputError(file.string() + ": damaged: its checksum is not that of its content");
  bytes.resize(content.size());
  return true;
}

// Of the first object of an archive, which begins with 0x80 | length of its class' name, the name, the
// version.
int versionOf(const std::vector<std::uint8_t>& bytes) {
  const std::size_t at = bytes.empty() ? 0 : 1u + (bytes[0] & 0x7fu);
  return at < bytes.size() ? bytes[at] : 0;
}

mrpt::serialization::CSerializable::Ptr readObject(const std::filesystem::path& file) {
  auto bytes = inflated(file);
  const bool checked = takeChecksum(bytes, file);
  auto object = parsed(bytes, file);
  if (!checked && versionOf(bytes) > 0 && std::dynamic_pointer_cast<CSemanticMap>(object))
    throw InputError(file.string() + ": damaged: its end, which holds the checksum, is missing");
  return object;
}

// MRPT's own function writes a temporary file, whose name two processes may share.
std::string gzipped(std::string_view bytes) {
  constexpr int kLevel = 6, kGzipWindow = 15 + 16, kMemory = 8;
  z_stream stream{};
  if (deflateInit2(&stream, kLevel, Z_DEFLATED, kGzipWindow, kMemory, Z_DEFAULT_STRATEGY) != Z_OK)
    throw std::bad_alloc();
  std::string out(deflateBound(&stream, bytes.size()), '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
  stream.avail_in = static_cast<uInt>(bytes.size());
  stream.next_out = reinterpret_cast<Bytef*>(out.data());
  stream.avail_out = static_cast<uInt>(out.size());
  const int code = deflate(&stream, Z_FINISH);
  out.resize(stream.total_out);
  deflateEnd(&stream);
  if (code != Z_STREAM_END) throw std::logic_error("zlib's bound of the compressed size does not hold");
  return out;
}

}  // namespace

void saveMap(const CSemanticMap& map, const std::filesystem::path& file) {
  mrpt::io::CMemoryStream memory;
  auto archive = mrpt::serialization::archiveFrom(memory);
  archive << map;
  std::string bytes(static_cast<const char*>(memory.getRawBufferData()),
                    static_cast<std::size_t>(memory.getTotalBytesCount()));
  bytes += std::string(kSumMark) + sha256Of(bytes);
  writeFileAtomically(file, gzipped(bytes));
}

CSemanticMap loadMap(const std::filesystem::path& file) {
  std::error_code error;
  const auto status = std::filesystem::status(file, error);
  if (!std::filesystem::exists(status)) throw InputError(file.string() + ": no such file");
  if (!std::filesystem::is_regular_file(status)) throw InputError(file.string() + ": not a file");
  if (std::filesystem::file_size(file, error) == 0) throw InputError(file.string() + ": empty file");
  observations::registerClasses();
  const auto object = readObject(file);
  const auto map = std::dynamic_pointer_cast<CSemanticMap>(object);
  if (!map)
    throw InputError(file.string() + ": holds " +
                     (object ? std::string("a ") + object->GetRuntimeClass()->className : "nothing") +
                     ", not a roomgraph map (CSemanticMap)");
  if (const auto problem = problemOf(*map); !problem.empty())
    throw InputError(file.string() + ": damaged: " + problem);
  return *map;
}

}  // namespace roomgraph
