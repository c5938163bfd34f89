// SPDX-License-Identifier: BSD-3-Clause
// Byte-wise copy of records merged with detections in time order; link to external images.
#include "roomgraph/datasets/rawlog_copy.h"

#include <mrpt/core/Clock.h>
#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CObservation.h>
#include <mrpt/obs/CSensoryFrame.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "image_folder.h"
#include "odometry_sum.h"
#include "plausibility.h"
#include "record_source.h"
#include "roomgraph/core/errors.h"
#include "roomgraph/core/output_file.h"
#include "roomgraph/observations/detection_comment.h"
#include "roomgraph/observations/rawlog_writer.h"

namespace roomgraph {
namespace {

namespace fs = std::filesystem;
using mrpt::serialization::CSerializable;

constexpr double kAtOnce = -std::numeric_limits<double>::infinity();

double stampOf(const mrpt::obs::CObservation& observation) {
  const auto t = toSeconds(observation.timestamp);
  return t && plausibleTime(*t) ? *t : kAtOnce;
}

// Earliest time of what a record holds; a record without a time goes with the one before it.
double timeOf(const CSerializable::Ptr& object) {
  if (const auto observation = std::dynamic_pointer_cast<mrpt::obs::CObservation>(object))
    return stampOf(*observation);
  const auto frame = std::dynamic_pointer_cast<mrpt::obs::CSensoryFrame>(object);
  double earliest = std::numeric_limits<double>::infinity();
  if (frame)
    for (const auto& observation : *frame) {
      if (!observation) continue;  // MRPT could not make it
      if (const double t = stampOf(*observation); t != kAtOnce) earliest = std::min(earliest, t);
    }
  return std::isfinite(earliest) ? earliest : kAtOnce;
}

// In either form; the new ones stand for them.
bool isDetections(const CSerializable::Ptr& object) {
  const auto comment = std::dynamic_pointer_cast<mrpt::obs::CObservationComment>(object);
  return comment ? holdsDetections(*comment)
                 : std::dynamic_pointer_cast<CObservationDetections>(object) != nullptr;
}

}  // namespace

struct RawlogCopy::Impl {
  Impl(const fs::path& in, const fs::path& out) : source(in), writer(out) { linkImages(in, out); }

  // The next record that is to be copied, in `waiting`; false at the end of the input.
  bool fill() {
    while (waiting.empty()) {
      const auto item = source.next();
      if (!item) return false;
      if (!item->object || isDetections(item->object)) continue;
      waiting = source.bytesSince(item->offset);
      waiting_t = timeOf(item->object);
    }
    return true;
  }
  void copyUntil(double t) {
    while (fill() && waiting_t < t) {
      writer.write(waiting);
      waiting.clear();
    }
  }

  RecordSource source;
  RawlogWriter writer;
  std::string waiting;  ///< a record that was read and not yet written
  double waiting_t = 0;
};

RawlogCopy::RawlogCopy(const fs::path& input, const fs::path& output) {
  requireOther(output, {input});
  impl_ = std::make_unique<Impl>(input, output);
}

RawlogCopy::~RawlogCopy() = default;

void RawlogCopy::insert(const CObservationDetections& detections) {
  impl_->copyUntil(mrpt::Clock::toDouble(detections.timestamp));
  impl_->writer.write(toComment(detections));
}

void RawlogCopy::finish() {
  impl_->copyUntil(std::numeric_limits<double>::infinity());
  impl_->writer.finish();
}

}  // namespace roomgraph
