// SPDX-License-Identifier: BSD-3-Clause
// Record headers of the ROS 1 bag format 2.0.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "byte_readers.h"

namespace roomgraph::bags {

/// Fields of a record's header by name.
using RecordFields = std::map<std::string, std::string, std::less<>>;

/// Parts of a record's header. Nothing when the bytes are none.
std::optional<RecordFields> parseFields(Bytes bytes);
/// A field as a number; nothing when it is missing or of another size.
template <class Number>
std::optional<Number> numberIn(const RecordFields& fields, std::string_view name) {
  const auto field = fields.find(name);
  if (field == fields.end() || field->second.size() != sizeof(Number)) return std::nullopt;
  Number value;
  std::memcpy(&value, field->second.data(), sizeof value);
  return value;
}

enum RecordKind : std::uint8_t {
  kMessageRecord = 2,
  kBagRecord = 3,
  kIndexRecord = 4,
  kChunkRecord = 5,
  kChunkInfoRecord = 6,
  kConnectionRecord = 7
};

}  // namespace roomgraph::bags
