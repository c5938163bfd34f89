// SPDX-License-Identifier: BSD-3-Clause
// Conversion between Detection and CObservationDetections; FNV-1a hash of a file.
#include "roomgraph/detection/detection_record.h"

#include <mrpt/core/Clock.h>

#include <array>
#include <cstdio>
#include <fstream>

#include "mask_memory.h"
#include "roomgraph/core/errors.h"

namespace roomgraph {

CObservationDetections toRecord(const Frame& frame, const std::vector<Detection>& detections,
                                const DetectorIdentity& identity, const std::vector<std::string>& unsought) {
  CObservationDetections out;
  out.timestamp = mrpt::Clock::fromDouble(frame.t);
  out.sensorLabel = "DETECTIONS";
  out.image_label = frame.sensor_label;
  out.image_width = static_cast<std::uint32_t>(frame.camera.width);
  out.image_height = static_cast<std::uint32_t>(frame.camera.height);
  out.model = identity.model;
  out.model_hash = identity.hash;
  out.score_threshold = static_cast<float>(identity.score_threshold);
  out.nms_threshold = static_cast<float>(identity.nms_threshold);
  out.unsought = unsought;
  for (const Detection& d : detections) {
    if (d.carried) continue;
    out.items.push_back({d.label.empty() ? d.class_name : d.label, d.score, d.box.u_min, d.box.v_min,
                         d.box.u_max, d.box.v_max, d.track.value, toRuns(d.mask)});
    if (!d.rival_label.empty())
      out.items.push_back({d.rival_label,
                           d.rival_score,
                           d.box.u_min,
                           d.box.v_min,
                           d.box.u_max,
                           d.box.v_max,
                           TrackId{}.value,
                           {}});
  }
  return out;
}

std::vector<Detection> detectionsOf(const CObservationDetections& record) {
  std::vector<Detection> out;
  MaskMemory memory_of_masks;
  for (const auto& item : record.items)
    out.push_back({{item.u_min, item.v_min, item.u_max, item.v_max},
                   "",
                   item.label,
                   item.score,
                   memory_of_masks.toMask(item.mask),
                   TrackId{item.track}});
  return out;
}

std::string fileHash(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) throw InputError(file + ": cannot be read");
  std::uint64_t hash = 0xcbf29ce484222325u;
  std::array<char, 1 << 16> bytes;
  while (in) {
    in.read(bytes.data(), bytes.size());
    for (std::streamsize i = 0; i < in.gcount(); ++i) {
      hash ^= static_cast<unsigned char>(bytes[static_cast<std::size_t>(i)]);
      hash *= 0x100000001b3u;
    }
  }
  char text[17];
  std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(hash));
  return text;
}

}  // namespace roomgraph
