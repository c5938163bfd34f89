// SPDX-License-Identifier: BSD-3-Clause
// Copy of a rawlog with comments unpacked into detections.
#include "roomgraph/datasets/detection_records.h"

#include <mrpt/obs/CSensoryFrame.h>

#include "image_folder.h"
#include "record_source.h"
#include "roomgraph/core/output_file.h"
#include "roomgraph/observations/detection_comment.h"
#include "roomgraph/observations/rawlog_writer.h"

namespace roomgraph {
namespace {

using mrpt::obs::CObservation;

// Detections instead of the comment that holds them; the observation itself otherwise.
CObservation::Ptr withOwnClass(const CObservation::Ptr& observation, DetectionRecords& counts) {
  const auto meant = unpacked(observation);
  if (!meant) {
    ++counts.damaged;
    return observation;
  }
  counts.detections += std::dynamic_pointer_cast<CObservationDetections>(*meant) != nullptr;
  return *meant;
}

// What is to be written in place of a record; null: the record as it stands.
mrpt::serialization::CSerializable::Ptr replacement(const mrpt::serialization::CSerializable::Ptr& object,
                                                    DetectionRecords& counts) {
  if (const auto observation = std::dynamic_pointer_cast<CObservation>(object)) {
    const auto other = withOwnClass(observation, counts);
    return other == observation ? nullptr : other;
  }
  const auto frame = std::dynamic_pointer_cast<mrpt::obs::CSensoryFrame>(object);
  if (!frame) return nullptr;
  auto out = mrpt::obs::CSensoryFrame::Create();
  bool changed = false;
  for (const auto& observation : *frame) {
    if (!observation) return nullptr;  // of a class that is not known here: nothing of the frame may get lost
    const auto other = withOwnClass(observation, counts);
    changed |= other != observation;
    out->insert(other);
  }
  return changed ? out : nullptr;
}

}  // namespace

DetectionRecords exportDetectionRecords(const std::filesystem::path& input,
                                        const std::filesystem::path& output,
                                        const std::function<void(double)>& progress) {
  requireOther(output, {input});
  RecordSource source(input);
  RawlogWriter writer(output);
  linkImages(input, output);
  DetectionRecords counts;
  while (const auto item = source.next()) {
    if (!item->object) continue;
    const auto other = replacement(item->object, counts);
    other ? writer.write(*other) : writer.write(source.bytesSince(item->offset));
    ++counts.records;
    if (progress) progress(source.progress());
  }
  writer.finish();
  return counts;
}

}  // namespace roomgraph
