// SPDX-License-Identifier: BSD-3-Clause
// Writer of a minimal ONNX model: the fields of its protocol buffers by hand.
#pragma once

#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

namespace roomgraph::test {
namespace onnx {

// Fields of protocol buffers: number and kind of a field, then its value.
inline std::string varint(std::uint64_t value) {
  std::string out;
  for (; value > 127; value >>= 7) out += static_cast<char>(value | 0x80);
  return out + static_cast<char>(value);
}
inline std::string number(int field, std::uint64_t value) {
  return varint(static_cast<std::uint64_t>(field) << 3) + varint(value);
}
inline std::string text(int field, const std::string& value) {
  return varint(static_cast<std::uint64_t>(field) << 3 | 2) + varint(value.size()) + value;
}

inline std::string valueInfo(const std::string& name, const std::vector<int>& sizes) {
  std::string shape;
  for (const int size : sizes) shape += text(1, number(1, static_cast<std::uint64_t>(size)));
  return text(1, name) + text(2, text(1, number(1, 1) + text(2, shape)));
}

inline std::string tensor(const std::string& name, const std::vector<int>& sizes,
                          const std::vector<float>& values) {
  std::string raw(values.size() * sizeof(float), '\0'), out;
  std::memcpy(raw.data(), values.data(), raw.size());
  for (const int size : sizes) out += number(1, static_cast<std::uint64_t>(size));
  return out + number(2, 1) + text(8, name) + text(9, raw);
}

inline std::string node(const std::string& type, const std::vector<std::string>& inputs,
                        const std::string& output, const std::string& attributes = "") {
  std::string out;
  for (const auto& input : inputs) out += text(1, input);
  return out + text(2, output) + text(3, output) + text(4, type) + attributes;
}

inline std::string integers(const std::string& name, const std::vector<int>& values) {
  constexpr int kAttribute = 5, kIntegers = 7;
  std::string all = text(1, name);
  for (const int value : values) all += number(8, static_cast<std::uint64_t>(value));
  return text(kAttribute, all + number(20, kIntegers));
}

inline std::string sizes(const std::string& name, const std::vector<std::int64_t>& values) {
  constexpr int kInt64 = 7;
  std::string raw(values.size() * sizeof(std::int64_t), '\0');
  std::memcpy(raw.data(), values.data(), raw.size());
  return number(1, values.size()) + number(2, kInt64) + text(8, name) + text(9, raw);
}

}  // namespace onnx

/// An ONNX model: a convolution of 1 x 1, a ReLU, the maximum over 2 x 2 pixels, all as rows of eight
/// numbers: a box, how sure it is, three classes.
inline std::string tinyOnnx() {
  using namespace onnx;
  const std::string graph =
      text(1, node("Conv", {"images", "weights", "bias"}, "sums", integers("kernel_shape", {1, 1}))) +
      text(1, node("Relu", {"sums"}, "positive")) +
      text(1, node("MaxPool", {"positive"}, "largest",
                   integers("kernel_shape", {2, 2}) + integers("strides", {2, 2}))) +
      text(1, node("Reshape", {"largest", "rows"}, "boxes")) + text(5, sizes("rows", {1, 64, 8})) +
      text(2, "tiny") + text(5, tensor("weights", {2, 3, 1, 1}, {.1f, .2f, .3f, .4f, .5f, .6f})) +
      text(5, tensor("bias", {2}, {.1f, -.1f})) + text(11, valueInfo("images", {1, 3, 32, 32})) +
      text(12, valueInfo("boxes", {1, 64, 8}));
  return number(1, 7) + text(2, "roomgraph") + text(7, graph) + text(8, number(2, 11));
}

}  // namespace roomgraph::test
