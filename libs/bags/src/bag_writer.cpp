// SPDX-License-Identifier: BSD-3-Clause
// Records of the bag format 2.0: header, chunks with their index, connections, chunk infos.
//
// Why not rosbag_storage: Debian's headers do not compile as installed (pluginlib's path), and the message
// packages need C++17 (allocator::rebind). What is left to do is this page.
#include "bag_writer.h"

#include <algorithm>
#include <limits>

#include "byte_writer.h"
#include "message_types.h"
#include "ros1_records.h"

namespace roomgraph::bags {
namespace {

constexpr std::size_t kChunkBytes = 768u << 10;
constexpr std::size_t kHeaderRecordBytes = 4096;  // room for its numbers, which are known at the end
constexpr std::uint32_t kIndexVersion = 1;

std::string number(auto value) {
  return ByteWriter().put(value).take();
}
std::string timeBytes(std::int64_t t_ns) {
  return ByteWriter().time(t_ns).take();
}

// Fields in the order of their names, as ROS writes them.
std::string fieldsOf(const std::map<std::string, std::string>& fields) {
  ByteWriter out;
  for (const auto& [name, value] : fields) out.text(name + "=" + value);
  return out.take();
}

std::string recordOf(std::map<std::string, std::string> fields, RecordKind kind, const std::string& data) {
  fields["op"] = std::string(1, static_cast<char>(kind));
  return ByteWriter().text(fieldsOf(fields)).text(data).take();
}

}  // namespace

BagWriter::BagWriter(const std::filesystem::path& bag) : file_(bag), out_(file_.path()) {
  writeHeader(0);
  position_ = static_cast<std::uint64_t>(out_.tellp());
}

void BagWriter::writeHeader(std::uint64_t index_position) {
  const std::string magic = "#ROSBAG V2.0\n";
  std::map<std::string, std::string> fields{
      {"index_pos", number(index_position)},
      {"conn_count", number(static_cast<std::uint32_t>(connections_.size()))},
      {"chunk_count", number(chunks_)}};
  const std::size_t bare = recordOf(fields, kBagRecord, "").size();
  out_.seekp(0);
  out_ << magic << recordOf(fields, kBagRecord, std::string(kHeaderRecordBytes - bare, ' '));
}

BagWriter::Connection& BagWriter::connection(const std::string& topic, const std::string& type,
                                             bool latched) {
  const auto known = connections_.find(topic);
  if (known != connections_.end()) return known->second;
  const auto& about = messageType(type);
  std::map<std::string, std::string> data{{"topic", topic},
                                          {"type", about.name},
                                          {"md5sum", about.md5},
                                          {"message_definition", about.definition}};
  if (latched) data["latching"] = "1";
  Connection added{static_cast<std::uint32_t>(connections_.size()), ""};
  added.record = recordOf({{"conn", number(added.id)}, {"topic", topic}}, kConnectionRecord, fieldsOf(data));
  chunk_ += added.record;
  return connections_.emplace(topic, std::move(added)).first->second;
}

void BagWriter::write(const std::string& topic, const std::string& type, std::int64_t t_ns,
                      const std::string& message, bool latched) {
  const auto& channel = connection(topic, type, latched);
  index_[channel.id].push_back({t_ns, static_cast<std::uint32_t>(chunk_.size())});
  chunk_ += recordOf({{"conn", number(channel.id)}, {"time", timeBytes(t_ns)}}, kMessageRecord, message);
  ++messages_[topic];
  if (chunk_.size() >= kChunkBytes) endChunk();
}

void BagWriter::endChunk() {
  if (chunk_.empty()) return;
  std::string behind;
  ByteWriter counts;
  std::int64_t first = std::numeric_limits<std::int64_t>::max(), last = 0;
  for (const auto& [id, entries] : index_) {
    ByteWriter data;
    for (const auto& entry : entries) {
      data.time(entry.t_ns).put(entry.offset);
      first = std::min(first, entry.t_ns);
      last = std::max(last, entry.t_ns);
    }
    const auto count = static_cast<std::uint32_t>(entries.size());
    behind += recordOf({{"ver", number(kIndexVersion)}, {"conn", number(id)}, {"count", number(count)}},
                       kIndexRecord, data.bytes());
    counts.put(id, count);
  }
  chunk_infos_ += recordOf({{"ver", number(kIndexVersion)},
                            {"chunk_pos", number(position_)},
                            {"start_time", timeBytes(first)},
                            {"end_time", timeBytes(last)},
                            {"count", number(static_cast<std::uint32_t>(index_.size()))}},
                           kChunkInfoRecord, counts.bytes());
  const auto size = static_cast<std::uint32_t>(chunk_.size());
  const std::string record =
      recordOf({{"compression", "none"}, {"size", number(size)}}, kChunkRecord, chunk_) + behind;
  out_ << record;
  out_.check();
  position_ += record.size();
  ++chunks_;
  chunk_.clear();
  index_.clear();
}

void BagWriter::finish() {
  endChunk();
  std::vector<const Connection*> in_order(connections_.size());
  for (const auto& [topic, channel] : connections_) in_order[channel.id] = &channel;
  for (const auto* channel : in_order) out_ << channel->record;
  out_ << chunk_infos_;
  writeHeader(position_);
  out_.finish();
  file_.commit();
}

}  // namespace roomgraph::bags
