// SPDX-License-Identifier: BSD-3-Clause
// Bounds-checked readers of ROS 1 serialisation and of CDR (ROS 2) with one interface.
#pragma once

#include <algorithm>
#include <array>
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

/// ROS 1, and the records of MCAP: little endian, no alignment, lengths of 32 bits.
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

/// CDR with its encapsulation header, of either byte order: numbers are aligned to their size, counted from
/// behind that header; texts count and have a zero at their end. (Fast-CDR copies all data, and when bytes
/// are stepped over it takes the next number for aligned.)
class CdrReader {
 public:
  static constexpr bool kRos1 = false;
  explicit CdrReader(Bytes bytes) {
    constexpr std::size_t kHeader = 4;
    if (bytes.size() < kHeader) throw BadMessage("ends too early");
    if (bytes[0] != 0 || bytes[1] > 1) throw BadMessage("is not in plain CDR");
    swapped_ = (bytes[1] == 1) != (std::endian::native == std::endian::little);
    bytes_ = bytes.subspan(kHeader);
  }
  template <class Number>
  Number number() {
    take((sizeof(Number) - at_ % sizeof(Number)) % sizeof(Number));
    std::array<std::uint8_t, sizeof(Number)> raw;
    const Bytes taken = take(sizeof(Number));
    std::copy(taken.begin(), taken.end(), raw.begin());
    if (swapped_) std::reverse(raw.begin(), raw.end());
    return std::bit_cast<Number>(raw);
  }
  Bytes take(std::size_t count) {
    if (count > left()) throw BadMessage("ends too early");
    at_ += count;
    return bytes_.subspan(at_ - count, count);
  }
  std::string text() {
    const Bytes taken = take(number<std::uint32_t>());
    std::string out(reinterpret_cast<const char*>(taken.data()), taken.size());
    if (!out.empty() && out.back() == '\0') out.pop_back();
    return out;
  }
  std::size_t left() const { return bytes_.size() - at_; }

 private:
  Bytes bytes_;
  std::size_t at_ = 0;
  bool swapped_ = false;
};

}  // namespace roomgraph::bags
