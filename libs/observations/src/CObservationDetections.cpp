// SPDX-License-Identifier: BSD-3-Clause
// Part of roomgraph, object-level semantic SLAM.
#include "roomgraph/observations/CObservationDetections.h"

#include <mrpt/serialization/CArchive.h>

#include <ostream>

namespace roomgraph {

IMPLEMENTS_SERIALIZABLE(CObservationDetections, mrpt::obs::CObservation, roomgraph)

std::uint8_t CObservationDetections::serializeGetVersion() const {
  return 0;
}

void CObservationDetections::serializeTo(mrpt::serialization::CArchive& out) const {
  out << timestamp << sensorLabel << sensor_pose_ << image_label << image_width << image_height << model
      << model_hash << score_threshold << nms_threshold;
  out.WriteAs<std::uint32_t>(items.size());
  for (const auto& item : items)
    out << item.label << item.score << item.u_min << item.v_min << item.u_max << item.v_max << item.track;
}

void CObservationDetections::serializeFrom(mrpt::serialization::CArchive& in, std::uint8_t version) {
  if (version != 0) MRPT_THROW_UNKNOWN_SERIALIZATION_VERSION(version);
  in >> timestamp >> sensorLabel >> sensor_pose_ >> image_label >> image_width >> image_height >> model >>
      model_hash >> score_threshold >> nms_threshold;
  items.resize(in.ReadAs<std::uint32_t>());
  for (auto& item : items)
    in >> item.label >> item.score >> item.u_min >> item.v_min >> item.u_max >> item.v_max >> item.track;
}

void CObservationDetections::getDescriptionAsText(std::ostream& out) const {
  CObservation::getDescriptionAsText(out);
  out << "Detections of " << model << (model_hash.empty() ? "" : " (" + model_hash + ")") << " on '"
      << image_label << "' " << image_width << "x" << image_height << ", score >= " << score_threshold
      << ", NMS " << nms_threshold << ": " << items.size() << " boxes\n";
  for (const auto& item : items)
    out << "  " << item.label << " " << item.score << " [" << item.u_min << ", " << item.v_min << ", "
        << item.u_max << ", " << item.v_max << "]"
        << (item.track < 0 ? "" : " track " + std::to_string(item.track)) << "\n";
}

}  // namespace roomgraph
