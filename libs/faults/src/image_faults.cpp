// SPDX-License-Identifier: BSD-3-Clause
// Uniform pictures, emptied detections and emptied depth images.
#include "image_faults.h"

#include <mrpt/obs/CObservationComment.h>

#include <opencv2/core/mat.hpp>

#include "roomgraph/observations/detection_comment.h"

namespace roomgraph {
namespace {

using mrpt::obs::CObservation3DRangeScan;

// Null when there are none in the record.
mrpt::obs::CObservation::Ptr withoutBoxes(const mrpt::obs::CObservation::Ptr& observation) {
  const auto read = unpacked(observation);
  const auto detections = read ? std::dynamic_pointer_cast<CObservationDetections>(*read) : nullptr;
  if (!detections || detections->items.empty()) return nullptr;
  CObservationDetections empty = *detections;
  empty.items.clear();
  return std::make_shared<mrpt::obs::CObservationComment>(toComment(empty));
}

}  // namespace

PassingRecords UniformPictureFault::pass(PassingRecord record) {
  if (record.sensor != FaultySensor::kCamera || !window_.contains(record.t)) return one(std::move(record));
  auto* images = dynamic_cast<CObservation3DRangeScan*>(record.observation.get());
  if (images && images->hasIntensityImage && !images->intensityImage.isEmpty()) {
    const cv::Mat before = images->intensityImage.asCvMat<cv::Mat>(mrpt::img::SHALLOW_COPY);
    const cv::Mat uniform(before.size(), before.type(), cv::Scalar::all(level_));
    images->intensityImage = mrpt::img::CImage(uniform, mrpt::img::SHALLOW_COPY);
    changed(record);
  } else if (const auto empty = images ? nullptr : withoutBoxes(record.observation)) {
    record.observation = empty;
    changed(record);
  }
  return one(std::move(record));
}

PassingRecords NoDepthFault::pass(PassingRecord record) {
  auto* images = dynamic_cast<CObservation3DRangeScan*>(record.observation.get());
  if (images && images->hasRangeImage && window_.contains(record.t)) {
    images->rangeImage.fill(0);
    for (auto& [name, layer] : images->rangeImageOtherLayers) layer.fill(0);
    images->hasPoints3D = false;
    images->resizePoints3DVectors(0);
    changed(record);
  }
  return one(std::move(record));
}

}  // namespace roomgraph
