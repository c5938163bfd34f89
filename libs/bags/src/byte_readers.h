// SPDX-License-Identifier: BSD-3-Clause
// Bounds-checked readers of ROS 1 serialisation and of CDR (ROS 2) with one interface.
#pragma once

#include <fastcdr/Cdr.h>
#include <fastcdr/FastBuffer.h>

#include <bit>
#include <cstdint>
#include <cstring>
#include <span>
#include <stdexcept>
#include <string>

namespace roomgraph::bags {

using Bytes = std::span<const std::uint8_t>;

/// A message that ends too early, or holds what its type does not allow.
struct BadMessage : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// Both readers give views into the message, so nothing is allocated by a length that the bytes do not bear.

/// ROS 1: little endian, no alignment, lengths of 32 bits.
class Ros1Reader {
 public:
  static constexpr bool kRos1 = true;
  explicit Ros1Reader(Bytes bytes) : bytes_(bytes) {
    static_assert(std::endian::native == std::endian::little);
  }
  template <class Number>
  Number number() {
    Number value;
    std::memcpy(&value, take(sizeof value).data(), sizeof value);
    return value;
  }
  Bytes take(std::size_t count) {
    if (count > bytes_.size()) throw BadMessage("ends too early");
    const Bytes taken = bytes_.first(count);
    bytes_ = bytes_.subspan(count);
    return taken;
  }
  std::string text() {
    const Bytes taken = take(number<std::uint32_t>());
    return {reinterpret_cast<const char*>(taken.data()), taken.size()};
  }
  std::size_t left() const { return bytes_.size(); }

 private:
  Bytes bytes_;
};

/// CDR with its encapsulation header, of either byte order; texts count and have a zero at their end.
class CdrReader {
 public:
  static constexpr bool kRos1 = false;
  explicit CdrReader(Bytes bytes)
      : bytes_(bytes),
        buffer_(reinterpret_cast<char*>(const_cast<std::uint8_t*>(bytes.data())), bytes.size()),
        cdr_(buffer_, eprosima::fastcdr::Cdr::DEFAULT_ENDIAN, eprosima::fastcdr::Cdr::DDS_CDR) {
    if (bytes.size() < 4) throw BadMessage("ends too early");
    if (bytes[0] != 0 || bytes[1] > 1) throw BadMessage("is not in plain CDR");
    cdr_.read_encapsulation();
  }
  template <class Number>
  Number number() {
    Number value;
    if (!tryNumber(value)) throw BadMessage("ends too early");
    return value;
  }
  Bytes take(std::size_t count) {
    const std::size_t at = bytes_.size() - left();
    if (count > left() || !cdr_.jump(count)) throw BadMessage("ends too early");
    return bytes_.subspan(at, count);
  }
  std::string text() {
    const Bytes taken = take(number<std::uint32_t>());
    std::string out(reinterpret_cast<const char*>(taken.data()), taken.size());
    if (!out.empty() && out.back() == '\0') out.pop_back();
    return out;
  }
  std::size_t left() const {
    return bytes_.size() -
           static_cast<std::size_t>(const_cast<eprosima::fastcdr::Cdr&>(cdr_).getCurrentPosition() -
                                    reinterpret_cast<const char*>(bytes_.data()));
  }

 private:
  template <class Number>
  bool tryNumber(Number& value) {
    try {
      cdr_.deserialize(value);
      return true;
    } catch (const eprosima::fastcdr::exception::Exception&) {
      return false;
    }
  }
  Bytes bytes_;
  eprosima::fastcdr::FastBuffer buffer_;
  eprosima::fastcdr::Cdr cdr_;
};

}  // namespace roomgraph::bags
