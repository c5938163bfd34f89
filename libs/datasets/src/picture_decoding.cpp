// SPDX-License-Identifier: BSD-3-Clause
// JPEG and PNG by OpenCV within a limit of memory; RVL.
#include "roomgraph/datasets/picture_decoding.h"

#include <algorithm>
#include <cstring>
#include <opencv2/imgcodecs.hpp>
#include <stdexcept>

#include "roomgraph/core/allocation_limit.h"
#include "roomgraph/observations/image_file.h"

namespace roomgraph {
namespace {

constexpr std::size_t kDecoderBytes = 256u << 20;

struct BadRvl : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// Words of 32 bits and the nibbles in them, from the highest on.
class RvlWords {
 public:
  explicit RvlWords(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}
  std::size_t left() const { return bytes_.size(); }
  std::uint32_t word() {
    std::uint32_t value = 0;
    if (bytes_.size() < sizeof value) throw BadRvl("ends too early");
    std::memcpy(&value, bytes_.data(), sizeof value);
    bytes_ = bytes_.subspan(sizeof value);
    return value;
  }
  /// Three bits in each nibble, and one that says whether another follows.
  std::uint32_t number() {
    std::uint32_t value = 0, nibble = 0;
    int shift = 0;
    do {
      if (nibbles_ == 0) {
        word_ = word();
        nibbles_ = 8;
      }
      nibble = word_ >> 28;
      word_ <<= 4;
      --nibbles_;
      if (shift > 30) throw BadRvl("RVL image is damaged");
      value |= (nibble & 7u) << shift;
      shift += 3;
    } while (nibble & 8u);
    return value;
  }

 private:
  std::span<const std::uint8_t> bytes_;
  std::uint32_t word_ = 0;
  int nibbles_ = 0;
};

// Run lengths of zeros and of values, these as differences in nibbles with a continuation bit (A. D. Wilson,
// "Fast lossless depth image compression", ISS 2017).
cv::Mat imageOfRvl(RvlWords in) {
  const std::uint32_t cols = in.word(), rows = in.word();
  constexpr std::uint64_t kMostPixels = 1u << 26, kPixelsPerByte = 1u << 20;
  const std::uint64_t pixels = static_cast<std::uint64_t>(cols) * rows;
  if (pixels == 0 || pixels > kMostPixels || pixels > in.left() * kPixelsPerByte)
    throw BadRvl("RVL image has an impossible size");
  cv::Mat image = cv::Mat::zeros(static_cast<int>(rows), static_cast<int>(cols), CV_16UC1);
  auto* out = image.ptr<std::uint16_t>();
  auto* const end = out + pixels;
  std::uint16_t previous = 0;
  while (out < end) {
    out += std::min<std::ptrdiff_t>(in.number(), end - out);
    for (std::uint32_t values = in.number(); values > 0 && out < end; --values) {
      const std::uint32_t zigzag = in.number();
      previous = static_cast<std::uint16_t>(previous + ((zigzag >> 1) ^ (0u - (zigzag & 1u))));
      *out++ = previous;
    }
  }
  return image;
}

}  // namespace

// Memory of decoders is bounded: a damaged size in a picture's header may ask for anything.
Outcome<cv::Mat> decodePicture(std::span<const std::uint8_t> bytes, int flags) {
  if (bytes.empty()) return Outcome<cv::Mat>::failure("compressed image is empty");
  countImageMemory();
  cv::Mat image;
  try {
    const AllocationLimit limit(kDecoderBytes);
    image = cv::imdecode(
        cv::Mat(1, static_cast<int>(bytes.size()), CV_8UC1, const_cast<std::uint8_t*>(bytes.data())), flags);
  } catch (const std::exception&) {
    image.release();
  }
  if (image.empty()) return Outcome<cv::Mat>::failure("compressed image is damaged, or neither JPEG nor PNG");
  return image;
}

Outcome<cv::Mat> decodeRvl(std::span<const std::uint8_t> bytes) {
  try {
    return imageOfRvl(RvlWords(bytes));
  } catch (const BadRvl& error) {
    return Outcome<cv::Mat>::failure(error.what());
  }
}

}  // namespace roomgraph
