// SPDX-License-Identifier: BSD-3-Clause
// map.rgmap: gzipped MRPT archive, read with bounded memory.
#include <mrpt/io/CFileGZInputStream.h>
#include <mrpt/io/CMemoryStream.h>
#include <mrpt/serialization/CArchive.h>
#include <zlib.h>

#include <new>
#include <stdexcept>

#include "map_check.h"
#include "roomgraph/core/allocation_limit.h"
#include "roomgraph/core/error_text.h"
#include "roomgraph/core/errors.h"
#include "roomgraph/core/output_file.h"
#include "roomgraph/mapping/map_files.h"
#include "roomgraph/observations/register_classes.h"

namespace roomgraph {
namespace {

constexpr std::size_t kLargestBytes = 128u
                                      << 20;  // a grid of 400 m x 400 m at 0.05 m, and 64 MB for the rest
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

mrpt::serialization::CSerializable::Ptr readObject(const std::filesystem::path& file) {
  const auto bytes = inflated(file);
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
    throw InputError(file.string() + ": not a roomgraph map, or damaged (" + what + ")");
  }
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
  writeFileAtomically(file, gzipped({static_cast<const char*>(memory.getRawBufferData()),
                                     static_cast<std::size_t>(memory.getTotalBytesCount())}));
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
