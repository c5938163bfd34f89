// SPDX-License-Identifier: BSD-3-Clause
// Sequential reading of chunks and messages, with search for the next chunk behind damage.
//
// Why not rosbag_storage: it refuses a bag without an index (a recorder that was
// killed, a disk that was full) and trusts the lengths in the file. Read from front to end, a bag needs no
// index, and a damaged place costs its chunk.
#include "ros1_bag.h"

#include <algorithm>
#include <map>
#include <optional>

#include "decompression.h"
#include "file_window.h"
#include "roomgraph/core/errors.h"
#include "ros1_records.h"
#include "topic_list.h"

namespace roomgraph::bags {
namespace {

constexpr std::string_view kFormat = "#ROSBAG V2.0\n";
constexpr std::size_t kLongestHeader = 1u << 20;

// A record in a file or in the content of a chunk.
struct RecordPlace {
  RecordFields fields;
  RecordKind kind{};
  std::uint64_t data = 0, end = 0;  ///< offsets
};

// `view(offset, count)` gives bytes of something that is `size` long.
template <class View>
std::optional<RecordPlace> recordAt(std::uint64_t offset, std::uint64_t size, View&& view) {
  const auto length = [&](std::uint64_t at) -> std::optional<std::uint32_t> {
    const Bytes bytes = view(at, 4);
    if (bytes.size() < 4) return std::nullopt;
    return Ros1Reader(bytes).number<std::uint32_t>();
  };
  const auto header = length(offset);
  if (!header || *header > kLongestHeader) return std::nullopt;
  const Bytes bytes = view(offset + 4, *header);
  if (bytes.size() < *header) return std::nullopt;
  auto fields = parseFields(bytes);
  if (!fields) return std::nullopt;
  const auto kind = numberIn<std::uint8_t>(*fields, "op");
  const auto data = length(offset + 4 + *header);
  if (!kind || !data) return std::nullopt;
  RecordPlace place{std::move(*fields), static_cast<RecordKind>(*kind), offset + 8 + *header, 0};
  place.end = place.data + *data;
  if (place.end > size) return std::nullopt;
  return place;
}

std::int64_t nanoseconds(const std::uint64_t time) {
  return static_cast<std::int64_t>(time & 0xffffffffu) * 1'000'000'000 +
         static_cast<std::int64_t>(time >> 32);
}

class Ros1Bag : public BagReader {
 public:
  explicit Ros1Bag(const std::filesystem::path& file) : file_(file), window_(file) { begin(file); }

  bool next(RawMessage& message) override {
    while (true) {
      if (in_chunk_ < chunk_.size()) {
        if (takeFromChunk(message)) return true;
      } else if (offset_ >= end_) {
        return false;
      } else if (takeFromFile(message)) {
        return true;
      }
    }
  }
  const std::vector<BagTopic>& topics() const override { return topics_.topics(); }
  void wants(std::function<Want(const BagTopic&)> wants) override { topics_.setWants(std::move(wants)); }
  double progress() const override {
    return static_cast<double>(offset_) / static_cast<double>(window_.size());
  }
  const std::vector<std::string>& problems() const override { return problems_; }

 private:
  void begin(const std::filesystem::path& file) {
    const Bytes magic = window_.at(0, kFormat.size());
    const std::string_view text(reinterpret_cast<const char*>(magic.data()), magic.size());
    if (text != kFormat)
      throw InputError(file.string() + ": is a ROS bag of another version (" +
                       std::string(text.substr(1, text.find('\n') - 1)) +
                       "); `rosbag fix` makes version 2.0 of it");
    offset_ = kFormat.size();
    end_ = window_.size();
    const auto record = fileRecord(offset_);
    if (!record || record->kind != kBagRecord) {
      problem("the record of the bag itself is damaged");
      return;
    }
    offset_ = record->end;
    const auto index = numberIn<std::uint64_t>(record->fields, "index_pos").value_or(0);
    if (index == 0)
      problem("no index: the recording was not ended properly; all of it that is there is read");
    else if (index > end_)
      problem("ends early: the index would begin at byte " + std::to_string(index) + ", the file has " +
              std::to_string(end_));
    else
      end_ = index;  // only the index behind it
  }

  std::optional<RecordPlace> fileRecord(std::uint64_t offset) {
    return recordAt(offset, window_.size(),
                    [this](std::uint64_t at, std::size_t count) { return window_.at(at, count); });
  }

  bool takeFromFile(RawMessage& message) {
    auto record = fileRecord(offset_);
    if (!record) {
      recover();
      return false;
    }
    const auto view = [this](std::uint64_t at, std::size_t count) { return window_.at(at, count); };
    if (record->kind == kChunkRecord) {
      enter(*record);
      return false;
    }
    offset_ = record->end;
    return take(*record, view, message);
  }

  // Records of an uncompressed chunk are read like those outside: images that nobody asks for are not read at
  // all.
  void enter(const RecordPlace& chunk) {
    const auto compression = chunk.fields.find("compression");
    if (compression == chunk.fields.end() || compression->second == "none") {
      chunk_end_ = chunk.end;
      offset_ = chunk.data;
      return;
    }
    offset_ = chunk.end;
    in_chunk_ = 0;
    try {
      decompress(compression->second,
                 window_.at(chunk.data, static_cast<std::size_t>(chunk.end - chunk.data)),
                 numberIn<std::uint32_t>(chunk.fields, "size").value_or(0), chunk_);
    } catch (const BadMessage& error) {
      damaged(chunk.data, error.what());
    }
  }

  bool takeFromChunk(RawMessage& message) {
    const auto view = [this](std::uint64_t at, std::size_t count) {
      const Bytes all(chunk_);
      return all.subspan(std::min<std::size_t>(at, all.size()))
          .first(std::min<std::size_t>(count, all.size() - std::min<std::size_t>(at, all.size())));
    };
    const auto record = recordAt(in_chunk_, chunk_.size(), view);
    if (!record) {
      damaged(offset_, "a record in the compressed chunk before it");
      in_chunk_ = chunk_.size();
      return false;
    }
    in_chunk_ = static_cast<std::size_t>(record->end);
    return take(*record, view, message);
  }

  template <class View>
  bool take(const RecordPlace& record, View&& view, RawMessage& message) {
    const auto id = numberIn<std::uint32_t>(record.fields, "conn");
    const auto length = static_cast<std::size_t>(record.end - record.data);
    if (record.kind == kConnectionRecord && id) connect(*id, record.fields, view(record.data, length));
    if (record.kind != kMessageRecord) return false;
    const auto time = numberIn<std::uint64_t>(record.fields, "time");
    const auto connection = id ? connections_.find(*id) : connections_.end();
    if (!time || connection == connections_.end()) {
      damaged(record.data, "a message of no known topic");
      return false;
    }
    const Want want = topics_.wanted(connection->second);
    if (want == Want::kNothing) return false;
    message.topic = connection->second;
    message.received_ns = nanoseconds(*time);
    message.cdr = false;
    message.bytes = view(record.data, want == Want::kAll ? length : std::min(length, kBeginningBytes));
    return true;
  }

  void connect(std::uint32_t id, const RecordFields& fields, Bytes data) {
    const auto about = parseFields(data);
    const auto topic = fields.find("topic");
    if (!about || topic == fields.end() || !about->contains("type")) return;
    connections_[id] = topics_.add({topic->second, about->find("type")->second});
  }

  void problem(const std::string& what) { problems_.push_back(file_.string() + ": " + what); }
  void damaged(std::uint64_t offset, const std::string& what) {
    constexpr int kTold = 3;
    if (++damages_ <= kTold) problem("damaged at byte " + std::to_string(offset) + ": " + what);
  }

  // Goes on with the next chunk: at the end of this one, or wherever one is found.
  void recover() {
    const std::uint64_t from = offset_;
    if (chunk_end_ > offset_ && fileRecord(chunk_end_))
      offset_ = chunk_end_;
    else
      offset_ = nextChunk(offset_ + 1);
    if (offset_ < end_)
      damaged(from, "no record there; goes on at byte " + std::to_string(offset_));
    else
      problem("ends early: no record at byte " + std::to_string(from) + " or behind it");
  }

  std::uint64_t nextChunk(std::uint64_t from) {
    constexpr std::string_view kField = "compression=";
    constexpr std::size_t kBlock = 128u << 10;
    // Before that field stand the lengths of header and field, and perhaps the other two fields.
    constexpr std::uint64_t kFarthest = 64, kNearest = 8;
    for (std::uint64_t at = from; at < end_;) {
      const Bytes block = window_.at(at, kBlock);
      const std::string text(reinterpret_cast<const char*>(block.data()), block.size());
      for (auto found = text.find(kField); found != text.npos; found = text.find(kField, found + 1))
        for (std::uint64_t back = kFarthest; back >= kNearest; --back) {
          if (at + found < from + back) continue;
          const auto record = fileRecord(at + found - back);
          if (record && record->kind == kChunkRecord) return at + found - back;
        }
      if (block.size() < kBlock) break;
      at += kBlock - kField.size();
    }
    return end_;
  }

  std::filesystem::path file_;
  FileWindow window_;
  std::uint64_t offset_ = 0, end_ = 0, chunk_end_ = 0;
  std::vector<std::uint8_t> chunk_;  ///< content of a compressed chunk
  std::size_t in_chunk_ = 0;
  std::map<std::uint32_t, std::size_t> connections_;
  TopicList topics_;
  std::vector<std::string> problems_;
  int damages_ = 0;
};

}  // namespace

std::unique_ptr<BagReader> openRos1Bag(const std::filesystem::path& file) {
  return std::make_unique<Ros1Bag>(file);
}

}  // namespace roomgraph::bags
