// SPDX-License-Identifier: BSD-3-Clause
// Observations corrected one by one, with embedded images.
#include "roomgraph/datasets/corrected_rawlog.h"

#include <mrpt/core/Clock.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/obs/CObservationOdometry.h>

#include <cmath>
#include <limits>

#include "flag_repair.h"
#include "frame_conversion.h"
#include "image_folder.h"
#include "record_correction.h"
#include "roomgraph/core/errors.h"
#include "roomgraph/core/output_file.h"
#include "roomgraph/datasets/observation_reader.h"
#include "roomgraph/datasets/rawlog_reader.h"
#include "roomgraph/observations/detection_comment.h"
#include "roomgraph/observations/rawlog_writer.h"
#include "sensor_choice.h"

namespace roomgraph {
namespace {

using mrpt::obs::CObservation;
using mrpt::obs::CObservation3DRangeScan;

// Sets how MRPT writes images, as long as it lives.
class ImageCompression {
 public:
  explicit ImageCompression(std::optional<int> jpeg_quality)
      : off_(mrpt::img::CImage::DISABLE_JPEG_COMPRESSION()),
        quality_(mrpt::img::CImage::SERIALIZATION_JPEG_QUALITY()) {
    mrpt::img::CImage::DISABLE_JPEG_COMPRESSION(!jpeg_quality);
    if (jpeg_quality) mrpt::img::CImage::SERIALIZATION_JPEG_QUALITY(*jpeg_quality);
  }
  ~ImageCompression() {
    mrpt::img::CImage::DISABLE_JPEG_COMPRESSION(off_);
    mrpt::img::CImage::SERIALIZATION_JPEG_QUALITY(quality_);
  }
  ImageCompression(const ImageCompression&) = delete;
  ImageCompression& operator=(const ImageCompression&) = delete;

 private:
  bool off_;
  int quality_;
};

void embedImages(CObservation3DRangeScan& images) {
  if (images.hasIntensityImage && images.intensityImage.isExternallyStored())
    images.intensityImage =
        mrpt::img::CImage(images.intensityImage.asCvMat<cv::Mat>(mrpt::img::DEEP_COPY), mrpt::img::DEEP_COPY);
  if (images.hasRangeImage && rangeImageIsInAFile(images)) images.rangeImage_forceResetExternalStorage();
}

void correctDepth(CObservation3DRangeScan& images, const DepthCorrection& depth,
                  const std::filesystem::path& input) {
  if (!images.hasRangeImage || depth == DepthCorrection{}) return;
  if (!images.range_is_depth && depth.bias_m != 0)
    throw RunError(
        input.string() + ": '" + images.sensorLabel +
        "' recorded ranges along rays, to which a bias of depth cannot be added; use the calibration file");
  images.rangeUnits *= static_cast<float>(depth.scale);
  const auto step = static_cast<int>(std::lround(depth.bias_m / images.rangeUnits));
  for (auto* value = images.rangeImage.data(); value != images.rangeImage.data() + images.rangeImage.size();
       ++value)
    if (*value > 0)
      *value = static_cast<std::uint16_t>(
          std::clamp(*value + step, 0, int{std::numeric_limits<std::uint16_t>::max()}));
  images.hasPoints3D = false;
}

// A stamp as the corrections have it, by way of a record of that sensor.
mrpt::Clock::time_point stampOf(Record record, RecordCorrection& correction) {
  correction.apply(record);
  return mrpt::Clock::fromDouble(timeOf(record));
}

CObservation::Ptr correctedObservation(const CObservation::Ptr& observation, const Calibration& calibration,
                                       RecordCorrection& correction, const std::filesystem::path& input) {
  const double t = mrpt::Clock::toDouble(observation->timestamp);
  placeSensor(*observation, calibration.poses);
  if (auto* images = dynamic_cast<CObservation3DRangeScan*>(observation.get())) {
    embedImages(*images);
    correctDepth(*images, calibration.corrections.depth, input);
    observation->timestamp = stampOf(Frame{.t = t, .sensor_label = observation->sensorLabel}, correction);
  } else if (dynamic_cast<mrpt::obs::CObservation2DRangeScan*>(observation.get())) {
    observation->timestamp = stampOf(Scan{.t = t, .sensor_label = observation->sensorLabel}, correction);
  } else if (auto* wheels = dynamic_cast<mrpt::obs::CObservationOdometry*>(observation.get())) {
    Record record = OdometryReading{t, {wheels->odometry.x(), wheels->odometry.y(), wheels->odometry.phi()}};
    correction.apply(record);
    const auto& reading = std::get<OdometryReading>(record);
    wheels->odometry = {reading.odom_from_robot.x, reading.odom_from_robot.y, reading.odom_from_robot.yaw};
    wheels->timestamp = mrpt::Clock::fromDouble(reading.t);
  } else if (const auto meant = unpacked(observation)) {
    const auto detections = std::dynamic_pointer_cast<CObservationDetections>(*meant);
    if (!detections) return observation;
    Record record = detections;
    correction.apply(record);
    return std::make_shared<mrpt::obs::CObservationComment>(toComment(*detections));
  }
  return observation;
}

}  // namespace

std::vector<std::string> writeCorrectedRawlog(const std::filesystem::path& input, const std::filesystem::path& output,
                          const Calibration& calibration, std::optional<int> jpeg_quality,
                          const std::function<void(double)>& progress) {
  requireOther(output, {input});
  checkLabels(input, {.sensor_poses = calibration.poses, .corrections = calibration.corrections});
  ObservationReader reader(input);
  RawlogWriter writer(output);
  RecordCorrection correction(calibration.corrections);
  const ImageCompression compression(jpeg_quality);
  while (const auto observation = reader.next()) {
    writer.write(*correctedObservation(observation, calibration, correction, input));
    if (progress) progress(reader.progress());
  }
  writer.finish();
  std::vector<std::string> left_out;
  for (const auto& [reason, count] : reader.skipped())
    left_out.push_back(input.string() + ": " + std::to_string(count) + " records left out: " + reason);
  if (!reader.truncation().empty()) left_out.push_back(reader.truncation());
  return left_out;
}

}  // namespace roomgraph
