// SPDX-License-Identifier: BSD-3-Clause
// Fields of record headers, name=value each.
#include "ros1_records.h"

namespace roomgraph::bags {

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

}  // namespace roomgraph::bags
