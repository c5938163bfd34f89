// SPDX-License-Identifier: BSD-3-Clause
// BagWriter: a ROS 1 bag with index, put into place when whole.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "roomgraph/core/output_file.h"

namespace roomgraph::bags {

/// Writes format 2.0, uncompressed. It holds one chunk and a few bytes for each one written.
class BagWriter {
 public:
  /// Throws RunError.
  explicit BagWriter(const std::filesystem::path& bag);

  /// A message in the serialisation of ROS 1; `latched`: whoever subscribes later gets it too. Throws
  /// RunError.
  void write(const std::string& topic, const std::string& type, std::int64_t t_ns, const std::string& message,
             bool latched = false);
  /// Writes the index and gives the file its name. Throws RunError.
  void finish();
  const std::map<std::string, int>& messages() const { return messages_; }

 private:
  struct Connection {
    std::uint32_t id = 0;
    std::string record;  ///< as it stands in the file
  };
  struct IndexEntry {
    std::int64_t t_ns = 0;
    std::uint32_t offset = 0;  ///< in the chunk
  };
  Connection& connection(const std::string& topic, const std::string& type, bool latched);
  void writeHeader(std::uint64_t index_position);
  void endChunk();

  PendingFile file_;
  OutputFile out_;
  std::uint64_t position_ = 0;
  std::string chunk_;
  std::map<std::uint32_t, std::vector<IndexEntry>> index_;  ///< of the chunk, by connection
  std::string chunk_infos_;                                 ///< records of all chunks
  std::uint32_t chunks_ = 0;
  std::map<std::string, Connection> connections_;  ///< by topic
  std::map<std::string, int> messages_;
};

}  // namespace roomgraph::bags
