// SPDX-License-Identifier: BSD-3-Clause
// Fields of MCAP's records in their order.
#include "mcap_records.h"

namespace roomgraph::bags {

McapSchema mcapSchema(Bytes content) {
  Ros1Reader in(content);
  McapSchema out;
  out.id = in.number<std::uint16_t>();
  out.name = in.text();
  return out;
}

McapChannel mcapChannel(Bytes content) {
  Ros1Reader in(content);
  McapChannel out;
  out.id = in.number<std::uint16_t>();
  out.schema = in.number<std::uint16_t>();
  out.topic = in.text();
  out.encoding = in.text();
  return out;
}

McapMessageHead mcapMessageHead(Bytes content) {
  Ros1Reader in(content);
  McapMessageHead out;
  out.channel = in.number<std::uint16_t>();
  in.number<std::uint32_t>();  // sequence
  out.log_time_ns = in.number<std::uint64_t>();
  in.number<std::uint64_t>();  // time of publishing
  return out;
}

McapChunkHead mcapChunkHead(Bytes beginning) {
  Ros1Reader in(beginning);
  McapChunkHead out;
  in.number<std::uint64_t>();  // times of its first and its last message
  in.number<std::uint64_t>();
  out.uncompressed_bytes = in.number<std::uint64_t>();
  out.crc = in.number<std::uint32_t>();
  out.compression = in.text();
  out.stored_bytes = in.number<std::uint64_t>();
  out.head_bytes = beginning.size() - in.left();
  return out;
}

}  // namespace roomgraph::bags
