// SPDX-License-Identifier: BSD-3-Clause
// Bounded scan of a rawlog's first records without decoding images.
#include "roomgraph/datasets/rawlog_peek.h"

#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/obs/CSensoryFrame.h>

#include <algorithm>
#include <iterator>

#include "record_source.h"
#include "roomgraph/observations/detection_comment.h"

namespace roomgraph {
namespace {

using mrpt::obs::CObservation;
using mrpt::obs::CObservation3DRangeScan;

constexpr int kRecords = 20000;
constexpr std::uint64_t kBytes = 128u << 20;
constexpr const char* kImages = "CObservation3DRangeScan";

std::vector<CObservation::Ptr> observationsIn(const mrpt::serialization::CSerializable::Ptr& object) {
  std::vector<CObservation::Ptr> out;
  if (const auto frame = std::dynamic_pointer_cast<mrpt::obs::CSensoryFrame>(object))
    std::copy_if(frame->begin(), frame->end(), std::back_inserter(out), [](const auto& observation) {
      return observation != nullptr;
    });  // null: MRPT could not make it
  else if (const auto single = std::dynamic_pointer_cast<CObservation>(object))
    out.push_back(single);
  return out;
}

void note(RawlogPeek& peek, const CObservation::Ptr& observation) {
  peek.frames |= std::dynamic_pointer_cast<CObservation3DRangeScan>(observation) != nullptr;
  const auto meant = unpacked(observation);
  peek.detections |= meant.ok() && std::dynamic_pointer_cast<CObservationDetections>(*meant) != nullptr;
}

}  // namespace

RawlogPeek peekRawlog(const std::filesystem::path& file) {
  RecordSource source(file);
  source.skipClass(kImages);
  RawlogPeek peek;
  for (int records = 0; records < kRecords && !(peek.frames && peek.detections); ++records) {
    const auto item = source.next();
    peek.whole = !item;
    if (!item || item->offset > kBytes) break;
    peek.frames |= !item->object && item->reason.starts_with(kImages);
    for (const auto& observation : observationsIn(item->object)) note(peek, observation);
  }
  return peek;
}

}  // namespace roomgraph
