// SPDX-License-Identifier: BSD-3-Clause
// Depth units, image files of imported records, MRPT's compression of images.
#include "roomgraph/datasets/import_images.h"

#include <mrpt/core/Clock.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <opencv2/imgcodecs.hpp>

#include "roomgraph/core/errors.h"
#include "roomgraph/core/output_file.h"

namespace roomgraph {
namespace {

void writePicture(const std::filesystem::path& file, const std::vector<std::uint8_t>& bytes) {
  OutputFile out(file);
  out.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  out.finish();
}

}  // namespace

double depthUnit(const cv::Mat& depth) {
  constexpr double kMillimetre = 0.001, kFine = 0.0002;
  return depth.type() == CV_16UC1 ? kMillimetre : kFine;
}

void setDepth(mrpt::obs::CObservation3DRangeScan& record, const cv::Mat& depth) {
  constexpr float kLargest = 65535;
  record.hasRangeImage = true;
  record.range_is_depth = true;
  record.rangeUnits = static_cast<float>(depthUnit(depth));
  record.rangeImage_setSize(depth.rows, depth.cols);
  const auto per_metre = static_cast<float>(1 / depthUnit(depth));
  for (int v = 0; v < depth.rows; ++v)
    for (int u = 0; u < depth.cols; ++u) {
      if (depth.type() == CV_16UC1) {
        record.rangeImage(v, u) = depth.at<std::uint16_t>(v, u);
        continue;
      }
      const float value = std::round(depth.at<float>(v, u) * per_metre);
      record.rangeImage(v, u) = value > 0 && value <= kLargest ? static_cast<std::uint16_t>(value) : 0;
    }
}

void storeOutside(mrpt::obs::CObservation3DRangeScan& record, const std::vector<std::uint8_t>& picture,
                  const ImportOutput& output) {
  char stamp[64];
  std::snprintf(stamp, sizeof stamp, "_%.6f", mrpt::Clock::toDouble(record.timestamp));
  std::string name = record.sensorLabel + stamp;
  std::replace(name.begin(), name.end(), '/', '_');
  if (record.hasIntensityImage) {
    const bool jpeg = picture.size() > 2 && picture[0] == 0xff && picture[1] == 0xd8;
    const std::string file = name + (picture.empty() || !jpeg ? "_rgb.png" : "_rgb.jpg");
    std::vector<std::uint8_t> bytes = picture;
    if (bytes.empty() &&
        !cv::imencode(".png", record.intensityImage.asCvMat<cv::Mat>(mrpt::img::SHALLOW_COPY), bytes))
      throw RunError("cannot write " + file + ": no PNG encoder");
    writePicture(output.images() / file, bytes);
    record.intensityImage.setExternalStorage(file);
  }
  if (record.hasRangeImage) output.storeDepth(record, name + "_depth.bin");
}

EmbeddedImages::EmbeddedImages(std::optional<int> jpeg_quality)
    : disabled_(mrpt::img::CImage::DISABLE_JPEG_COMPRESSION()),
      quality_(mrpt::img::CImage::SERIALIZATION_JPEG_QUALITY()) {
  mrpt::img::CImage::DISABLE_JPEG_COMPRESSION(!jpeg_quality);
  if (jpeg_quality) mrpt::img::CImage::SERIALIZATION_JPEG_QUALITY(*jpeg_quality);
}

EmbeddedImages::~EmbeddedImages() {
  mrpt::img::CImage::DISABLE_JPEG_COMPRESSION(disabled_);
  mrpt::img::CImage::SERIALIZATION_JPEG_QUALITY(quality_);
}

}  // namespace roomgraph
