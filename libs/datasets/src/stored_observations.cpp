// SPDX-License-Identifier: BSD-3-Clause
// Observations of sensory frames and actions one by one; external images loaded and detached from their
// files.
#include "roomgraph/datasets/stored_observations.h"

#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/obs/CSensoryFrame.h>

#include <deque>
#include <opencv2/core/mat.hpp>

#include "flag_repair.h"
#include "frame_conversion.h"
#include "image_folder.h"
#include "image_memory.h"
#include "odometry_sum.h"
#include "record_source.h"

namespace roomgraph {

using mrpt::obs::CObservation;
using mrpt::obs::CObservation3DRangeScan;

struct StoredObservationReader::Impl {
  explicit Impl(const std::filesystem::path& file) : source(file), image_folder(imageFolderOf(file)) {}

  void take(const RecordSource::Item& item);
  void takeActions(const mrpt::obs::CActionCollection& actions);
  void releaseOdometry(mrpt::Clock::time_point t);
  /// Whether the observation had images in files and has them in itself now.
  bool embedImages(CObservation& observation);
  void release(const CObservation::Ptr& observation, std::string bytes);

  RecordSource source;
  std::string image_folder;
  OdometrySum odometry;
  bool odometry_waits = false;  ///< for the time of the next observation
  std::deque<StoredObservation> waiting;
  std::map<std::string, int> skipped;
};

void StoredObservationReader::Impl::releaseOdometry(mrpt::Clock::time_point t) {
  auto reading = mrpt::obs::CObservationOdometry::Create();
  const Pose2 pose = odometry.pose();
  reading->odometry = {pose.x, pose.y, pose.yaw};
  reading->timestamp = t;
  waiting.push_back({reading, ""});
}

void StoredObservationReader::Impl::takeActions(const mrpt::obs::CActionCollection& actions) {
  if (const auto problem = odometry.add(actions); !problem.empty()) {
    ++skipped["CActionCollection: " + problem];
    return;
  }
  odometry_waits = !odometry.time();
  if (!odometry_waits) releaseOdometry(mrpt::Clock::fromDouble(*odometry.time()));
}

bool StoredObservationReader::Impl::embedImages(CObservation& observation) {
  auto* images = dynamic_cast<CObservation3DRangeScan*>(&observation);
  if (!images) return false;
  const bool color = images->hasIntensityImage && images->intensityImage.isExternallyStored();
  const bool depth = images->hasRangeImage && rangeImageIsInAFile(*images);
  if ((!color && !depth) || !missingExternalFile(*images, image_folder).empty()) return false;
  try {
    loadImages(*images);
    if (color) images->intensityImage.forceLoad();
  } catch (const std::exception& error) {
    ++skipped["CObservation3DRangeScan: image unreadable: " + firstLine(error)];
    return false;
  }
  if (color) {
    const cv::Mat pixels = images->intensityImage.asCvMat<cv::Mat>(mrpt::img::DEEP_COPY);
    images->intensityImage = mrpt::img::CImage(pixels, mrpt::img::SHALLOW_COPY);
  }
  images->rangeImage_forceResetExternalStorage();
  return true;
}

void StoredObservationReader::Impl::release(const CObservation::Ptr& observation, std::string bytes) {
  if (!observation) return;  // MRPT could not make it
  if (odometry_waits && observation->timestamp != INVALID_TIMESTAMP) {
    odometry_waits = false;
    releaseOdometry(observation->timestamp);
  }
  if (embedImages(*observation)) bytes.clear();
  waiting.push_back({observation, std::move(bytes)});
}

void StoredObservationReader::Impl::take(const RecordSource::Item& item) {
  if (const auto actions = std::dynamic_pointer_cast<mrpt::obs::CActionCollection>(item.object))
    takeActions(*actions);
  else if (const auto frame = std::dynamic_pointer_cast<mrpt::obs::CSensoryFrame>(item.object))
    for (const auto& observation : *frame) release(observation, "");
  else if (const auto single = std::dynamic_pointer_cast<CObservation>(item.object))
    release(single, source.bytesSince(item.offset));
  else
    ++skipped[shortClassName(item.object->GetRuntimeClass()->className) + ": no observation"];
}

StoredObservationReader::StoredObservationReader(const std::filesystem::path& file)
    : impl_(std::make_unique<Impl>(file)) {}
StoredObservationReader::~StoredObservationReader() = default;
StoredObservationReader::StoredObservationReader(StoredObservationReader&&) noexcept = default;
StoredObservationReader& StoredObservationReader::operator=(StoredObservationReader&&) noexcept = default;

std::optional<StoredObservation> StoredObservationReader::next() {
  while (impl_->waiting.empty()) {
    const auto item = impl_->source.next();
    if (!item) return std::nullopt;
    if (item->object)
      impl_->take(*item);
    else
      ++impl_->skipped[item->reason];
  }
  auto first = std::move(impl_->waiting.front());
  impl_->waiting.pop_front();
  return first;
}

double StoredObservationReader::progress() const {
  return impl_->source.progress();
}
const std::map<std::string, int>& StoredObservationReader::skipped() const {
  return impl_->skipped;
}
const std::string& StoredObservationReader::truncation() const {
  return impl_->source.truncation();
}

}  // namespace roomgraph
