// SPDX-License-Identifier: BSD-3-Clause
// Detections through MRPT's archives.
#include "detection_bytes.h"

#include <mrpt/io/CMemoryStream.h>
#include <mrpt/serialization/CArchive.h>
#include <mrpt/serialization/stl_serialization.h>

#include "mask_memory.h"
#include "roomgraph/observations/growing_reads.h"

namespace roomgraph {

using mrpt::serialization::archiveFrom;
using mrpt::serialization::CArchive;

namespace {

void write(CArchive& out, const Detection& d) {
  const MaskRuns mask = toRuns(d.mask);
  out << d.box.u_min << d.box.v_min << d.box.u_max << d.box.v_max << d.class_name << d.label << d.score;
  out << mask.width << mask.height << mask.runs << d.track.value << d.carried << d.rival_score
      << d.rival_label;
}

// MRPT's own reader of a bool makes one of any byte, which is undefined but for 0 and 1.
bool readFlag(CArchive& in) {
  return in.ReadAs<std::uint8_t>() != 0;
}

Detection read(CArchive& in, MaskMemory& memory_of_masks) {
  Detection d;
  MaskRuns mask;
  in >> d.box.u_min >> d.box.v_min >> d.box.u_max >> d.box.v_max;
  d.class_name = readText(in);
  d.label = readText(in);
  in >> d.score >> mask.width >> mask.height;
  mask.runs = readGrowing<std::vector<std::uint32_t>>(in);
  in >> d.track.value;
  d.carried = readFlag(in);
  in >> d.rival_score;
  d.rival_label = readText(in);
  d.mask = memory_of_masks.toMask(mask);
  return d;
}

}  // namespace

std::string bytesOf(const Outcome<std::vector<Detection>>& found) {
  mrpt::io::CMemoryStream memory;
  auto out = archiveFrom(memory);
  out << found.ok() << found.reason() << static_cast<std::uint32_t>(found ? found->size() : 0);
  if (found)
    for (const Detection& detection : *found) write(out, detection);
  return {static_cast<const char*>(memory.getRawBufferData()),
          static_cast<std::size_t>(memory.getTotalBytesCount())};
}

Outcome<std::vector<Detection>> detectionsFrom(const std::string& bytes) {
  mrpt::io::CMemoryStream memory;
  memory.assignMemoryNotOwn(bytes.data(), bytes.size());
  auto in = archiveFrom(memory);
  const bool ok = readFlag(in);
  const std::string reason = readText(in);
  const auto count = in.ReadAs<std::uint32_t>();
  if (!ok) return Outcome<std::vector<Detection>>::failure(reason);
  std::vector<Detection> detections;
  MaskMemory memory_of_masks;
  for (std::uint32_t i = 0; i < count; ++i) detections.push_back(read(in, memory_of_masks));
  return detections;
}

}  // namespace roomgraph
