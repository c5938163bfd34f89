// SPDX-License-Identifier: BSD-3-Clause
// Raw encodings, JPEG and PNG, and the two formats of compressed depth.
#include "image_decoding.h"

#include <algorithm>
#include <bit>
#include <map>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "roomgraph/datasets/picture_decoding.h"

namespace roomgraph::bags {
namespace {

struct RawEncoding {
  int type;             ///< of the pixels as they stand in the message
  int conversion = -1;  ///< to BGR; -1: none
};

const std::map<std::string, RawEncoding>& colorEncodings() {
  // A Bayer pattern is named after its first two pixels by ROS, after the second row's by OpenCV.
  static const std::map<std::string, RawEncoding> encodings{
      {"rgb8", {CV_8UC3, cv::COLOR_RGB2BGR}},
      {"bgr8", {CV_8UC3}},
      {"8UC3", {CV_8UC3}},
      {"rgba8", {CV_8UC4, cv::COLOR_RGBA2BGR}},
      {"bgra8", {CV_8UC4, cv::COLOR_BGRA2BGR}},
      {"8UC4", {CV_8UC4, cv::COLOR_BGRA2BGR}},
      {"mono8", {CV_8UC1}},
      {"8UC1", {CV_8UC1}},
      {"yuv422", {CV_8UC2, cv::COLOR_YUV2BGR_UYVY}},
      {"uyvy", {CV_8UC2, cv::COLOR_YUV2BGR_UYVY}},
      {"yuv422_yuy2", {CV_8UC2, cv::COLOR_YUV2BGR_YUY2}},
      {"yuyv", {CV_8UC2, cv::COLOR_YUV2BGR_YUY2}},
      {"bayer_rggb8", {CV_8UC1, cv::COLOR_BayerBG2BGR}},
      {"bayer_bggr8", {CV_8UC1, cv::COLOR_BayerRG2BGR}},
      {"bayer_gbrg8", {CV_8UC1, cv::COLOR_BayerGR2BGR}},
      {"bayer_grbg8", {CV_8UC1, cv::COLOR_BayerGB2BGR}},
  };
  return encodings;
}

bool isDepth16(const std::string& encoding) {
  return encoding == "16UC1" || encoding == "mono16";
}

// The pixels where they are in the message.
cv::Mat viewOf(const ImageMessage& image, int type) {
  constexpr std::uint32_t kLargest = 1u << 16;
  const std::size_t row = static_cast<std::size_t>(image.width) * CV_ELEM_SIZE(type);
  if (image.width == 0 || image.height == 0 || image.width > kLargest || image.height > kLargest)
    throw BadMessage("image of " + std::to_string(image.width) + "x" + std::to_string(image.height) + " px");
  if (image.step < row || static_cast<std::size_t>(image.step) * (image.height - 1) + row > image.data.size())
    throw BadMessage("image has fewer bytes than its size needs");
  return cv::Mat(static_cast<int>(image.height), static_cast<int>(image.width), type,
                 const_cast<std::uint8_t*>(image.data.data()), image.step);
}

void swapBytes(cv::Mat& image) {
  const std::size_t width = image.elemSize();
  for (int v = 0; v < image.rows; ++v)
    for (auto* p = image.ptr(v); p < image.ptr(v) + static_cast<std::size_t>(image.cols) * width; p += width)
      std::reverse(p, p + width);
}

cv::Mat valueOr(const Outcome<cv::Mat>& image) {
  if (!image) throw BadMessage(image.reason());
  return *image;
}

// 12 bytes (format, two parameters of the quantisation), then PNG or RVL. Floats are stored as their inverse.
cv::Mat decodeCompressedDepth(const ImageMessage& image) {
  Ros1Reader in(image.data);
  in.number<std::uint32_t>();
  const auto a = in.number<float>(), b = in.number<float>();
  const Bytes rest = in.take(in.left());
  cv::Mat stored = image.encoding.find("rvl") != std::string::npos
                       ? valueOr(decodeRvl(rest))
                       : valueOr(decodePicture(rest, cv::IMREAD_UNCHANGED));
  if (stored.type() != CV_16UC1) throw BadMessage("compressed depth is not of 16 bit");
  if (!image.encoding.starts_with("32FC1")) return stored;
  cv::Mat metres(stored.size(), CV_32FC1);
  for (int v = 0; v < stored.rows; ++v)
    for (int u = 0; u < stored.cols; ++u) {
      const auto value = stored.at<std::uint16_t>(v, u);
      metres.at<float>(v, u) = value == 0 ? 0.f : a / (static_cast<float>(value) - b);
    }
  return metres;
}

}  // namespace

cv::Mat colorImageOf(const ImageMessage& image, bool compressed) {
  if (compressed) {
    const cv::Mat out = valueOr(decodePicture(image.data, cv::IMREAD_ANYCOLOR));
    if (out.type() != CV_8UC3 && out.type() != CV_8UC1) throw BadMessage("compressed image is not of 8 bit");
    return out;
  }
  const auto found = colorEncodings().find(image.encoding);
  if (found == colorEncodings().end()) throw BadMessage("encoding '" + image.encoding + "' is not known");
  const cv::Mat view = viewOf(image, found->second.type);
  // Two pixels share their colour; OpenCV does not look whether there are two.
  if (found->second.type == CV_8UC2 && image.width % 2 != 0)
    throw BadMessage("image in " + image.encoding + " has an odd width");
  if (found->second.conversion < 0) return view.clone();
  cv::Mat out;
  try {
    cv::cvtColor(view, out, found->second.conversion);
  } catch (const cv::Exception&) {
    throw BadMessage("image of " + std::to_string(image.width) + "x" + std::to_string(image.height) +
                     " px cannot be in " + image.encoding);
  }
  return out;
}

cv::Mat depthImageOf(const ImageMessage& image, bool compressed) {
  if (compressed) {
    if (image.encoding.find("compressedDepth") != std::string::npos) return decodeCompressedDepth(image);
    const cv::Mat out = valueOr(decodePicture(image.data, cv::IMREAD_UNCHANGED));
    if (out.type() != CV_16UC1) throw BadMessage("compressed depth is not of 16 bit");
    return out;
  }
  const bool metres = image.encoding == "32FC1";
  if (!metres && !isDepth16(image.encoding))
    throw BadMessage("encoding '" + image.encoding + "' is not known for depth");
  cv::Mat out = viewOf(image, metres ? CV_32FC1 : CV_16UC1).clone();
  if (image.big_endian == (std::endian::native == std::endian::little)) swapBytes(out);
  return out;
}

ImageContent contentOf(const std::string& encoding) {
  const std::string raw = encoding.substr(0, encoding.find(';'));
  if (isDepth16(raw) || raw == "32FC1") return ImageContent::kDepth;
  if (raw == "mono8" || raw == "8UC1") return ImageContent::kGray;
  if (colorEncodings().contains(raw)) return ImageContent::kColor;
  const bool picture = raw == "jpeg" || raw == "jpg" || raw == "png";  // of drivers that tell no more
  return picture ? ImageContent::kColor : ImageContent::kUnknown;
}

}  // namespace roomgraph::bags
