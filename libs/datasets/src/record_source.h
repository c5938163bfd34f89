// SPDX-License-Identifier: BSD-3-Clause
// Serialised objects of a rawlog, one by one, with recovery after broken records.
#pragma once

#include <mrpt/serialization/CSerializable.h>

#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>

#include "replay_stream.h"
#include "roomgraph/core/error_text.h"

namespace roomgraph {

/// Serialised objects of a rawlog one after the other; steps over broken ones.
class RecordSource {
 public:
  /// Throws InputError (missing, empty, not a rawlog).
  explicit RecordSource(const std::filesystem::path& file);

  /// Records of these classes (names without namespace) are stepped over without being parsed, which is much
  /// cheaper for images.
  void skipClass(const std::string& name) { skip_class_ = name; }

  struct Item {
    mrpt::serialization::CSerializable::Ptr object;  ///< null: skipped
    std::string reason;                              ///< why it was skipped
    std::uint64_t offset = 0;                        ///< in the uncompressed data
  };
  /// Nothing at the end of the file; truncation() then says whether the end came too early.
  std::optional<Item> next();

  /// The bytes from an offset up to the end of the item that next() gave last, which must have an object.
  std::string bytesSince(std::uint64_t offset);

  const std::string& truncation() const { return truncation_; }
  double progress() const;

 private:
  /// Class name in the object header at `offset`; empty when there is none.
  std::string headerAt(std::uint64_t offset, std::size_t* length = nullptr);
  /// Offset of the next record at or after `from`; nothing when the file ends before.
  /// `pairs`: only actions and sensory frames count.
  std::optional<std::uint64_t> findRecord(std::uint64_t from, bool pairs);
  std::uint64_t endOfData(std::uint64_t from);
  /// Bytes from the header at `offset` to the next record, but no more than a record can have.
  std::size_t lengthOf(std::uint64_t offset, const std::string& name);
  /// Bytes that parsing may allocate.
  std::size_t allowanceFor(std::uint64_t offset, const std::string& name);
  /// Throws std::bad_alloc when the record asks for more memory than its length can need.
  void parse(Item& item, const std::string& name);
  std::optional<Item> stepOver(Item item);
  std::optional<Item> recover(Item item, const std::string& cause);
  void setTruncated(std::uint64_t offset, const std::string& cause);

  ReplayStream stream_;
  std::string skip_class_, truncation_;
  bool frames_format_ = false;                    ///< action/sensory-frame pairs
  std::map<std::string, std::uint64_t> lengths_;  ///< of the last sound record of each class, bytes
};

/// Class name without its namespace.
std::string shortClassName(const std::string& name);

}  // namespace roomgraph
