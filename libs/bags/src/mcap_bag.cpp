// SPDX-License-Identifier: BSD-3-Clause
// Sequential reading of MCAP's records and chunks, with search for the next chunk behind damage. Debian has
// no library for this container, whose format is public and small.
#include "mcap_bag.h"

#include <zlib.h>

#include <algorithm>
#include <map>
#include <optional>
#include <set>

#include "decompression.h"
#include "file_window.h"
#include "mcap_records.h"
#include "roomgraph/core/errors.h"
#include "topic_list.h"

namespace roomgraph::bags {
namespace {

constexpr std::uint64_t kMostChunkBytes = 256u
                                          << 20;  // rosbag2 writes chunks of less than 1 MB, others of a few

struct McapPlace {
  std::uint8_t opcode = 0;
  std::uint64_t data = 0, length = 0;  ///< offsets; it may end behind the file
  std::uint64_t end() const { return data + length; }
};

std::optional<McapPlace> placeAt(std::uint64_t offset, Bytes head) {
  if (head.size() < kMcapRecordHead) return std::nullopt;
  Ros1Reader in(head);
  const auto opcode = in.number<std::uint8_t>();
  const auto length = in.number<std::uint64_t>();
  const std::uint64_t data = offset + kMcapRecordHead;
  if (opcode == 0 || length > std::uint64_t(-1) - data) return std::nullopt;
  return McapPlace{opcode, data, length};
}

// Whether the fields of a chunk agree with each other.
bool isChunk(const McapPlace& place, Bytes beginning) {
  try {
    const auto head = mcapChunkHead(beginning);
    return head.head_bytes + head.stored_bytes == place.length && head.uncompressed_bytes <= kMostChunkBytes;
  } catch (const BadMessage&) {
    return false;
  }
}

class McapBag : public BagReader {
 public:
  explicit McapBag(std::vector<std::filesystem::path> files) : files_(std::move(files)) { openFile(); }

  bool next(RawMessage& message) override {
    while (window_) {
      if (in_chunk_ < chunk_.size()) {
        if (takeFromChunk(message)) return true;
      } else if (offset_ >= window_->size()) {
        closeFile();
      } else if (takeFromFile(message)) {
        return true;
      }
    }
    return false;
  }
  const std::vector<BagTopic>& topics() const override { return topics_.topics(); }
  void wants(std::function<Want(const BagTopic&)> wants) override { topics_.setWants(std::move(wants)); }
  double progress() const override {
    const double within = window_ ? static_cast<double>(std::min(offset_, window_->size())) /
                                        static_cast<double>(window_->size())
                                  : 1;
    return (static_cast<double>(current_) + within - 1) / static_cast<double>(files_.size());
  }
  const std::vector<std::string>& problems() const override { return problems_; }

 private:
  auto fileView() {
    return [this](std::uint64_t at, std::size_t count) { return window_->at(at, count); };
  }
  std::optional<McapPlace> fileRecord(std::uint64_t offset) {
    return placeAt(offset, window_->at(offset, kMcapRecordHead));
  }

  void openFile() {
    const auto& file = files_[current_++];
    window_ = std::make_unique<FileWindow>(file);
    const Bytes magic = window_->at(0, kMcapMagic.size());
    if (!std::equal(magic.begin(), magic.end(), kMcapMagic.begin(), kMcapMagic.end(),
                    [](std::uint8_t a, char b) { return a == static_cast<std::uint8_t>(b); }))
      throw InputError(file.string() + ": is MCAP of another version than 0, or damaged at its beginning");
    offset_ = kMcapMagic.size();
    ended_ = false;
    damages_ = 0;
    channels_.clear();
    schemas_.clear();
    readSummary();
  }

  // Behind the data, a recorder that ended properly defines all topics once more: the chunk that did it first
  // may be damaged.
  void readSummary() {
    const std::uint64_t footer = kMcapRecordHead + kMcapFooterBytes + kMcapMagic.size();
    if (window_->size() < kMcapMagic.size() + footer) return;
    const auto place = fileRecord(window_->size() - footer);
    if (!place || place->opcode != kMcapFooter || place->length != kMcapFooterBytes) return;
    std::uint64_t at = Ros1Reader(window_->at(place->data, 8)).number<std::uint64_t>();
    RawMessage none;
    while (at != 0) {
      const auto record = fileRecord(at);
      if (!record || record->end() > window_->size() || record->opcode == kMcapFooter) return;
      if (record->opcode == kMcapSchema || record->opcode == kMcapChannel) take(*record, fileView(), none);
      at = record->end();
    }
  }

  void closeFile() {
    if (!ended_) problem("no end: the recording was not ended properly; all of it that is there is read");
    window_.reset();
    if (current_ < files_.size()) openFile();
  }

  bool takeFromFile(RawMessage& message) {
    const auto place = fileRecord(offset_);
    if (!place || place->end() > window_->size()) {
      takeIncomplete(place);
      return false;
    }
    offset_ = place->end();
    if (place->opcode == kMcapDataEnd || place->opcode == kMcapFooter) {  // only summary and index behind it
      ended_ = true;
      offset_ = window_->size();
      return false;
    }
    if (place->opcode == kMcapChunk) {
      enter(*place);
      return false;
    }
    return take(*place, fileView(), message);
  }

  bool takeFromChunk(RawMessage& message) {
    const Bytes content(chunk_);
    const auto view = [&](std::uint64_t at, std::size_t count) {
      return content.subspan(at, std::min(count, content.size() - static_cast<std::size_t>(at)));
    };
    const auto place = placeAt(in_chunk_, view(in_chunk_, kMcapRecordHead));
    if (!place || place->end() > content.size()) {
      if (!ended_) damaged(offset_, "a record in the chunk before it");
      in_chunk_ = content.size();
      return false;
    }
    in_chunk_ = static_cast<std::size_t>(place->end());
    return take(*place, view, message);
  }

  // Decompresses a chunk whose end may be missing.
  void enter(const McapPlace& place) {
    chunk_.clear();
    in_chunk_ = 0;
    const bool whole = place.end() <= window_->size();
    try {
      const auto head = mcapChunkHead(window_->at(
          place.data, static_cast<std::size_t>(std::min<std::uint64_t>(place.length, kMcapChunkHeadMost))));
      if (head.head_bytes + head.stored_bytes > place.length)
        throw BadMessage("its lengths contradict each other");
      if (head.uncompressed_bytes > kMostChunkBytes)
        throw BadMessage(std::to_string(head.uncompressed_bytes) + " bytes are too many for a chunk");
      const auto begin = place.data + head.head_bytes;
      const Bytes stored =
          window_->at(begin, static_cast<std::size_t>(std::min(
                                 head.stored_bytes, window_->size() - std::min(begin, window_->size()))));
      if (head.compression.empty())
        chunk_.assign(stored.begin(), stored.end());
      else
        decompress(head.compression, stored, static_cast<std::size_t>(head.uncompressed_bytes), chunk_);
      if (whole && head.crc != 0 && crc32(0, chunk_.data(), static_cast<uInt>(chunk_.size())) != head.crc)
        throw BadMessage("its checksum is another");
    } catch (const BadMessage& error) {
      if (!whole) return;  // what came before its end is used
      damaged(place.data, std::string("a chunk is left out: ") + error.what());
      chunk_.clear();
    }
  }

  template <class View>
  bool take(const McapPlace& place, View&& view, RawMessage& message) {
    const auto length = static_cast<std::size_t>(place.length);
    try {
      if (place.opcode == kMcapSchema) {
        const auto schema = mcapSchema(view(place.data, length));
        schemas_[schema.id] = schema.name;
      } else if (place.opcode == kMcapChannel) {
        connect(mcapChannel(view(place.data, length)));
      } else if (place.opcode == kMcapMessage) {
        return takeMessage(place, view, message);
      }
    } catch (const BadMessage& error) {
      damaged(place.data, error.what());
    }
    return false;
  }

  template <class View>
  bool takeMessage(const McapPlace& place, View&& view, RawMessage& message) {
    const auto head = mcapMessageHead(view(place.data, static_cast<std::size_t>(std::min<std::uint64_t>(
                                                           place.length, McapMessageHead::kBytes))));
    const auto channel = channels_.find(head.channel);
    if (channel == channels_.end()) throw BadMessage("a message of no known topic");
    if (!channel->second.topic) return false;
    const Want want = topics_.wanted(*channel->second.topic);
    if (want == Want::kNothing) return false;
    const auto length = static_cast<std::size_t>(place.length) - McapMessageHead::kBytes;
    message.topic = *channel->second.topic;
    message.received_ns = static_cast<std::int64_t>(head.log_time_ns);
    message.cdr = channel->second.cdr;
    message.bytes = view(place.data + McapMessageHead::kBytes,
                         want == Want::kAll ? length : std::min(length, kBeginningBytes));
    return true;
  }

  void connect(const McapChannel& channel) {
    auto& known = channels_[channel.id];
    known.cdr = channel.encoding == "cdr";
    if (!known.cdr && channel.encoding != "ros1") {
      known.topic.reset();
      if (left_out_.insert(channel.topic).second)
        problem(channel.topic + " is left out: messages in '" + channel.encoding + "'");
      return;
    }
    const auto schema = schemas_.find(channel.schema);
    known.topic = topics_.add({channel.topic, schema == schemas_.end() ? "" : ros1Name(schema->second)});
  }

  // A record that the file does not hold: its end is missing, or its length is damaged.
  void takeIncomplete(const std::optional<McapPlace>& place) {
    const std::uint64_t from = offset_;
    offset_ = nextChunk(offset_ + 1);
    if (offset_ < window_->size()) {
      damaged(from, "no record there; goes on at byte " + std::to_string(offset_));
      return;
    }
    ended_ = true;
    problem("ends early: no whole record at byte " + std::to_string(from));
    if (place && place->opcode == kMcapChunk) enter(*place);
  }

  std::uint64_t nextChunk(std::uint64_t from) {
    constexpr std::size_t kBlock = 128u << 10;
    for (std::uint64_t at = from; at < window_->size(); at += kBlock) {
      const Bytes view = window_->at(at, kBlock);
      const std::vector<std::uint8_t> block(view.begin(), view.end());
      for (auto found = std::find(block.begin(), block.end(), kMcapChunk); found != block.end();
           found = std::find(found + 1, block.end(), kMcapChunk)) {
        const std::uint64_t offset = at + static_cast<std::uint64_t>(found - block.begin());
        const auto place = fileRecord(offset);
        if (place && place->end() <= window_->size() &&
            isChunk(*place, window_->at(place->data, kMcapChunkHeadMost)))
          return offset;
      }
    }
    return window_->size();
  }

  void problem(const std::string& what) { problems_.push_back(files_[current_ - 1].string() + ": " + what); }
  void damaged(std::uint64_t offset, const std::string& what) {
    constexpr int kTold = 3;
    if (++damages_ <= kTold) problem("damaged at byte " + std::to_string(offset) + ": " + what);
  }

  struct Channel {
    std::optional<std::size_t> topic;  ///< none: its messages cannot be read
    bool cdr = false;
  };

  std::vector<std::filesystem::path> files_;
  std::size_t current_ = 0;  ///< of the next file
  std::unique_ptr<FileWindow> window_;
  std::uint64_t offset_ = 0;
  bool ended_ = false;               ///< its end was found, or it was told that there is none
  std::vector<std::uint8_t> chunk_;  ///< content of the last chunk
  std::size_t in_chunk_ = 0;
  std::map<std::uint16_t, std::string> schemas_;
  std::map<std::uint16_t, Channel> channels_;
  TopicList topics_;
  std::set<std::string> left_out_;
  std::vector<std::string> problems_;
  int damages_ = 0;
};

}  // namespace

std::unique_ptr<BagReader> openMcapBag(const std::vector<std::filesystem::path>& files) {
  return std::make_unique<McapBag>(files);
}

}  // namespace roomgraph::bags
