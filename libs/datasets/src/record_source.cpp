// SPDX-License-Identifier: BSD-3-Clause
// Search for record boundaries, memory allowance per record, and parsing by MRPT.
#include "record_source.h"

#include <mrpt/obs/CAction.h>
#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CObservation.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/obs/registerAllClasses.h>
#include <mrpt/rtti/CObject.h>
#include <mrpt/serialization/CSerializable.h>

#include <algorithm>
#include <cstring>
#include <new>
#include <stdexcept>

#include "action_check.h"
#include "flag_repair.h"
#include "roomgraph/core/allocation_limit.h"
#include "roomgraph/core/errors.h"
#include "roomgraph/core/unexpected.h"
#include "roomgraph/observations/image_file.h"
#include "roomgraph/observations/register_classes.h"

namespace roomgraph {
namespace {

constexpr std::uint8_t kNewFormat =
    0x80;  // set in the length byte of a header; older files have a 32 bit length
constexpr std::uint8_t kEndFlag = 0x88;  // last byte of every object
// What parsing may allocate: some small containers, and all that the record holds several times over.
constexpr std::size_t kSpareBytes = 1u << 20, kBytesPerByte = 8;
constexpr std::size_t kScanBytes = 1u << 16, kImageBytes = 2u << 20, kLongestRecordBytes = 64u << 20;

bool isNameCharacter(std::uint8_t c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == ':' ||
         c == '<' || c == '>';
}

// A header of MRPT's begins with the length of the name. Says no to nearly all bytes that are none, cheaply.
bool maybeHeader(const std::uint8_t* bytes, std::size_t count) {
  constexpr std::size_t kLooked = 5;
  if (count < kLooked) return true;
  const bool new_format = bytes[0] & kNewFormat;
  if (!new_format && (bytes[1] || bytes[2] || bytes[3])) return false;
  const std::size_t first = new_format ? 1 : 4;
  return std::all_of(bytes + first, bytes + kLooked, isNameCharacter);
}

enum class Kind { kPair, kObservation, kOther, kUnknown };

Kind kindOf(const std::string& class_name) {
  const auto* id = mrpt::rtti::findRegisteredClass(class_name);
  if (!id) return Kind::kUnknown;
  if (id->derivedFrom(CLASS_ID(mrpt::obs::CActionCollection)) ||
      id->derivedFrom(CLASS_ID(mrpt::obs::CSensoryFrame)))
    return Kind::kPair;
  return id->derivedFrom(CLASS_ID(mrpt::obs::CObservation)) ? Kind::kObservation : Kind::kOther;
}

bool looksLikeRecord(const std::string& class_name) {
  const Kind kind = kindOf(class_name);
  if (kind == Kind::kUnknown) return class_name.find("Observation") != std::string::npos;
  return kind != Kind::kOther;
}

}  // namespace

std::string shortClassName(const std::string& name) {
  const auto colon = name.rfind(':');
  return colon == std::string::npos ? name : name.substr(colon + 1);
}

RecordSource::RecordSource(const std::filesystem::path& file) : stream_(file) {
  mrpt::obs::registerAllClasses_mrpt_obs();
  observations::registerClasses();
  const std::string first = headerAt(0);
  if (first.empty()) throw InputError(file.string() + ": not a rawlog (does not begin with an MRPT object)");
  if (!looksLikeRecord(first))
    throw InputError(file.string() + ": not a rawlog (holds an object of class " + first + ")");
  frames_format_ = kindOf(first) == Kind::kPair;
  countImageMemory();
}

double RecordSource::progress() const {
  if (stream_.fileSize() == 0) return 1;
  return std::min(1.0, static_cast<double>(stream_.filePosition()) / static_cast<double>(stream_.fileSize()));
}

std::string RecordSource::headerAt(std::uint64_t offset, std::size_t* length) {
  const std::uint8_t* head = stream_.peek(offset, 1);
  if (!head) return "";
  std::size_t count = *head, prefix = 1;
  if (count & kNewFormat) {
    count &= 0x7f;
  } else {
    head = stream_.peek(offset, 4);
    if (!head || head[1] || head[2] || head[3]) return "";
    prefix = 4;
  }
  if (count < 4 || count > 100) return "";
  const std::uint8_t* name = stream_.peek(offset + prefix, count);
  if (!name || !std::all_of(name, name + count, isNameCharacter)) return "";
  if (length) *length = prefix + count;
  return std::string(reinterpret_cast<const char*>(name), count);
}

std::optional<std::uint64_t> RecordSource::findRecord(std::uint64_t from, bool pairs) {
  for (std::uint64_t block = from;;) {
    std::size_t size = 16 * 1024;
    while (size > 0 && !stream_.peek(block, size)) size /= 2;
    if (size == 0) return std::nullopt;
    for (std::size_t i = 0; i < size; ++i) {
      // Looked up again each time: headerAt() may move the buffer.
      const std::uint8_t* bytes = stream_.peek(block, size);
      const void* flag = std::memchr(bytes + i, kEndFlag, size - i);
      if (!flag) break;
      i = static_cast<std::size_t>(static_cast<const std::uint8_t*>(flag) - bytes);
      if (!maybeHeader(bytes + i + 1, size - i - 1)) continue;
      const std::uint64_t candidate = block + i + 1;
      const std::string name = headerAt(candidate);
      const bool fits = pairs ? kindOf(name) == Kind::kPair : looksLikeRecord(name);
      if (!name.empty() && fits) return candidate;
    }
    block += size;
  }
}

std::uint64_t RecordSource::endOfData(std::uint64_t from) {
  std::uint64_t end = from;
  for (std::size_t step = 1u << 20; step > 0; step /= 2)
    while (stream_.peek(end, step)) end += step;
  return end;
}

std::size_t RecordSource::lengthOf(std::uint64_t offset, const std::string& name) {
  // A sensory frame holds observations: only the next pair ends it.
  const auto next_record = findRecord(offset + name.size(), frames_format_ || kindOf(name) == Kind::kPair);
  const std::uint64_t length = (next_record ? *next_record : endOfData(offset)) - offset;
  return static_cast<std::size_t>(std::min<std::uint64_t>(length, kLongestRecordBytes));
}

void RecordSource::setTruncated(std::uint64_t offset, const std::string& cause) {
  truncation_ = "the file ends in the middle of a record that begins at byte " + std::to_string(offset) +
                " of the uncompressed data (file offset " + std::to_string(stream_.filePosition()) + " of " +
                std::to_string(stream_.fileSize()) + "): " + cause;
}

std::optional<RecordSource::Item> RecordSource::recover(Item item, const std::string& cause) {
  const auto next_record = findRecord(item.offset, frames_format_);
  if (!next_record) {
    setTruncated(item.offset, stream_.damage().empty() ? cause : stream_.damage());
    return std::nullopt;
  }
  stream_.rewind(*next_record);
  item.reason = "broken record: " + cause;
  return item;
}

std::optional<RecordSource::Item> RecordSource::stepOver(Item item) {
  item.reason = skip_class_ + ": not asked for";
  if (const auto next_record = findRecord(item.offset, frames_format_)) {
    stream_.rewind(*next_record);
    return item;
  }
  // The last record of the file: complete when the data ends with the end flag.
  const std::uint64_t end = endOfData(item.offset);
  if (stream_.damage().empty() && *stream_.peek(end - 1, 1) == kEndFlag) {
    stream_.rewind(end);
    return item;
  }
  setTruncated(item.offset, stream_.damage().empty() ? "data is missing" : stream_.damage());
  return std::nullopt;
}

std::string RecordSource::bytesSince(std::uint64_t offset) {
  const auto count = static_cast<std::size_t>(stream_.position() - offset);
  const std::uint8_t* bytes = stream_.peek(offset, count);
  return bytes ? std::string(reinterpret_cast<const char*>(bytes), count) : "";
}

std::optional<RecordSource::Item> RecordSource::next() {
  if (!truncation_.empty()) return std::nullopt;
  stream_.mark();
  Item item;
  item.offset = stream_.position();
  if (stream_.atEnd()) {
    if (!stream_.damage().empty()) setTruncated(item.offset, stream_.damage());
    return std::nullopt;
  }
  const std::string name = headerAt(item.offset);
  if (name.empty()) return recover(item, "no object header");
  if (!skip_class_.empty() && shortClassName(name) == skip_class_) return stepOver(item);
  if (kindOf(name) == Kind::kUnknown) return recover(item, "unknown class " + name);
  const std::size_t shortages = memoryShortages();
  try {
    parse(item, name);
    return item;
  } catch (const std::bad_alloc& error) {
    throwIfShort(error, shortages);
    return recover(item, shortClassName(name) + ": a size in it does not fit its length");
  } catch (const std::exception& error) {
    throwIfShort(error, shortages);
    return recover(item, stream_.metEnd() ? shortClassName(name) + ": data is missing"
                                          : shortClassName(name) + ": " + firstLine(error));
  }
}

// Looking for the end of a record takes time, most of all for images: left out for a class whose last record
// was of their size. Never after an attempt that failed: an image of MRPT's whose memory was
// refused is half made, and its pool would give it to the next record of that size.
std::size_t RecordSource::allowanceFor(std::uint64_t offset, const std::string& name) {
  const auto last = lengths_.find(name);
  const bool image = last != lengths_.end() && last->second >= kScanBytes && last->second < kImageBytes;
  return kSpareBytes + kBytesPerByte * (image ? 2 * kImageBytes : lengthOf(offset, name));
}

void RecordSource::parse(Item& item, const std::string& name) {
  if (shortClassName(name) == "CActionCollection") {
    const std::size_t length = lengthOf(item.offset, name);
    const auto* bytes = stream_.peek(item.offset, length);
    if (bytes && !movementsCanBeParsed({reinterpret_cast<const char*>(bytes), length}))
      throw std::runtime_error("a movement without its distribution");
  }
  const std::size_t allowance = allowanceFor(item.offset, name);
  {
    const AllocationLimit limit(allowance);
    item.object = stream_.ReadObject();
  }
  if (item.object) repairFlags(*item.object);
  lengths_[name] = stream_.position() - item.offset;
  frames_format_ = kindOf(name) == Kind::kPair;
}

}  // namespace roomgraph
