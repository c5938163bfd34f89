// SPDX-License-Identifier: BSD-3-Clause
// Serialisation and description of detection records.
#include "roomgraph/observations/CObservationDetections.h"

#include <mrpt/serialization/CArchive.h>
#include <mrpt/serialization/stl_serialization.h>

#include <algorithm>
#include <cctype>
#include <ostream>
#include <sstream>

#include "roomgraph/observations/growing_reads.h"

namespace roomgraph {

IMPLEMENTS_SERIALIZABLE(CObservationDetections, mrpt::obs::CObservation, roomgraph)

namespace {

// Version 0 had 32-bit boxes and no masks, version 1 no classes that were not looked for.
template <class Number>
void readItem(mrpt::serialization::CArchive& in, CObservationDetections::Item& item) {
  item.label = readText(in);
  for (double* value : {&item.score, &item.u_min, &item.v_min, &item.u_max, &item.v_max})
    *value = static_cast<double>(in.ReadAs<Number>());
  in >> item.track;
}

}  // namespace

std::uint8_t CObservationDetections::serializeGetVersion() const {
  return 2;
}

void CObservationDetections::serializeTo(mrpt::serialization::CArchive& out) const {
  out << timestamp << sensorLabel << sensor_pose_ << image_label << image_width << image_height << model
      << model_hash << score_threshold << nms_threshold;
  out.WriteAs<std::uint32_t>(items.size());
  for (const auto& item : items) {
    out << item.label << item.score << item.u_min << item.v_min << item.u_max << item.v_max << item.track;
    out << item.mask.width << item.mask.height << item.mask.runs;
  }
  out.WriteAs<std::uint32_t>(unsought.size());
  for (const auto& name : unsought) out << name;
}

void CObservationDetections::serializeFrom(mrpt::serialization::CArchive& in, std::uint8_t version) {
  if (version > 2) MRPT_THROW_UNKNOWN_SERIALIZATION_VERSION(version);
  in >> timestamp;
  sensorLabel = readText(in);
  in >> sensor_pose_;
  image_label = readText(in);
  in >> image_width >> image_height;
  model = readText(in);
  model_hash = readText(in);
  in >> score_threshold >> nms_threshold;
  items = readList(in, [version](mrpt::serialization::CArchive& from) {
    Item item;
    version == 0 ? readItem<float>(from, item) : readItem<double>(from, item);
    if (version == 0) return item;
    from >> item.mask.width >> item.mask.height;
    item.mask.runs = readGrowing<std::vector<std::uint32_t>>(from);
    return item;
  });
  unsought.clear();
  if (version >= 2) unsought = readList(in, readText);
}

void CObservationDetections::getDescriptionAsText(std::ostream& out) const {
  CObservation::getDescriptionAsText(out);
  out << "Detections of " << model << (model_hash.empty() ? "" : " (" + model_hash + ")") << " on '"
      << image_label << "' " << image_width << "x" << image_height << ", score >= " << score_threshold
      << ", NMS " << nms_threshold << ": " << items.size() << " boxes\n";
  for (const auto& name : unsought) out << "  not looked for: " << name << "\n";
  for (const auto& item : items)
    out << "  " << item.label << " " << item.score << " [" << item.u_min << ", " << item.v_min << ", "
        << item.u_max << ", " << item.v_max << "]" << (item.mask.runs.empty() ? "" : " with mask")
        << (item.track < 0 ? "" : " track " + std::to_string(item.track)) << "\n";
}

std::string CObservationDetections::exportTxtHeader() const {
  return "boxes, then of each: label score u_min v_min u_max v_max";
}

std::string CObservationDetections::exportTxtDataRow() const {
  std::ostringstream out;
  out << items.size();
  for (const auto& item : items) {
    std::string label = item.label.empty() ? "-" : item.label;
    std::replace_if(
        label.begin(), label.end(), [](unsigned char c) { return std::isspace(c) != 0; }, '_');
    out << " " << label << " " << item.score << " " << item.u_min << " " << item.v_min << " " << item.u_max
        << " " << item.v_max;
  }
  return out.str();
}

}  // namespace roomgraph
