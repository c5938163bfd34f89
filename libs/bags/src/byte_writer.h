// SPDX-License-Identifier: BSD-3-Clause
// ByteWriter: numbers and texts in the serialisation of ROS 1.
#pragma once

#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

#include "roomgraph/geometry/pose.h"

namespace roomgraph::bags {

class ByteWriter {
 public:
  /// Any number of numbers, each as wide as its type.
  template <class... Numbers>
  ByteWriter& put(Numbers... numbers) {
    (append(&numbers, sizeof numbers), ...);
    return *this;
  }
  /// The same number `count` times.
  template <class Number>
  ByteWriter& fill(Number number, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) put(number);
    return *this;
  }
  ByteWriter& text(std::string_view text) {
    put(static_cast<std::uint32_t>(text.size()));
    bytes_ += text;
    return *this;
  }
  ByteWriter& raw(std::string_view bytes) {
    bytes_ += bytes;
    return *this;
  }
  ByteWriter& time(std::int64_t t_ns) {
    constexpr std::int64_t kSecond = 1'000'000'000;
    return put(static_cast<std::uint32_t>(t_ns / kSecond), static_cast<std::uint32_t>(t_ns % kSecond));
  }
  /// std_msgs/Header.
  ByteWriter& header(std::int64_t t_ns, std::string_view frame) {
    put(std::uint32_t{0});
    return time(t_ns).text(frame);
  }
  /// geometry_msgs/Pose and Transform, which have the same bytes.
  ByteWriter& pose(const Pose3& pose) {
    const Eigen::Quaterniond q(pose.linear());
    const auto p = pose.translation();
    return put(p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), q.w());
  }
  const std::string& bytes() const { return bytes_; }
  std::string take() { return std::move(bytes_); }

 private:
  void append(const void* data, std::size_t size) { bytes_.append(static_cast<const char*>(data), size); }
  std::string bytes_;
};

}  // namespace roomgraph::bags
