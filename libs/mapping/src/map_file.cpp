// SPDX-License-Identifier: BSD-3-Clause
// Part of roomgraph, object-level semantic SLAM.
#include <mrpt/core/exceptions.h>
#include <mrpt/io/CFileGZInputStream.h>
#include <mrpt/io/CMemoryStream.h>
#include <mrpt/io/zip.h>
#include <mrpt/serialization/CArchive.h>

#include "roomgraph/core/errors.h"
#include "roomgraph/core/output_file.h"
#include "roomgraph/mapping/map_files.h"
#include "roomgraph/observations/register_classes.h"

namespace roomgraph {
namespace {

/// MRPT prefixes its messages with file and line and appends a backtrace: keeps the line that says what
/// happened.
std::string cause(const std::exception& error) {
  std::string text = error.what();
  const auto mark = text.rfind("Message:");
  if (mark != std::string::npos) text = text.substr(mark + 8);
  const auto start = text.find_first_not_of(" \t\n");
  if (start == std::string::npos) return "unreadable";
  return text.substr(start, text.find('\n', start) - start);
}

mrpt::serialization::CSerializable::Ptr readObject(const std::filesystem::path& file) {
  mrpt::io::CFileGZInputStream in;
  if (!in.open(file.string())) throw InputError(file.string() + ": cannot be opened");
  try {
    return mrpt::serialization::archiveFrom(in).ReadObject();
  } catch (const std::exception& error) {
    const std::string what = cause(error);
    if (what.find("version") != std::string::npos)
      throw InputError(file.string() + ": was written by a newer version of roomgraph (" + what + ")");
    throw InputError(file.string() + ": not a roomgraph map, or damaged (" + what + ")");
  }
}

}  // namespace

void saveMap(const CSemanticMap& map, const std::filesystem::path& file) {
  mrpt::io::CMemoryStream memory;
  auto archive = mrpt::serialization::archiveFrom(memory);
  archive << map;
  const auto* begin = static_cast<const std::uint8_t*>(memory.getRawBufferData());
  std::vector<std::uint8_t> zipped;
  if (!mrpt::io::zip::compress_gz_data_block({begin, begin + memory.getTotalBytesCount()}, zipped, 6))
    throw RunError("cannot write " + file.string() + ": compression failed");
  writeFileAtomically(file, {reinterpret_cast<const char*>(zipped.data()), zipped.size()});
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
  return *map;
}

}  // namespace roomgraph
