// SPDX-License-Identifier: BSD-3-Clause
// Flattening of sensory frames and actions into single observations with loaded images.
#include "roomgraph/datasets/observation_reader.h"

#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/obs/CSensoryFrame.h>

#include <deque>

#include "frame_conversion.h"
#include "image_folder.h"
#include "image_memory.h"
#include "odometry_sum.h"
#include "plausibility.h"
#include "record_source.h"

namespace roomgraph {

using mrpt::obs::CObservation3DRangeScan;

struct ObservationReader::Impl {
  explicit Impl(const std::filesystem::path& file) : source(file), image_folder(imageFolderOf(file)) {}

  void take(const mrpt::serialization::CSerializable::Ptr& object);
  void takeActions(const mrpt::obs::CActionCollection& actions);
  mrpt::obs::CObservation::Ptr odometryAt(mrpt::Clock::time_point t);
  /// Empty, or why the observation cannot be used.
  std::string problemWith(mrpt::obs::CObservation& observation) const;

  RecordSource source;
  std::string image_folder;
  OdometrySum odometry;
  bool odometry_waits = false;  ///< for the time of the next observation
  std::deque<mrpt::obs::CObservation::Ptr> waiting;  ///< of one sensory frame
  std::map<std::string, int> skipped;
};

void ObservationReader::Impl::takeActions(const mrpt::obs::CActionCollection& actions) {
  if (const auto problem = odometry.add(actions); !problem.empty()) {
    ++skipped["CActionCollection: " + problem];
    return;
  }
  odometry_waits = !odometry.time();
  if (!odometry_waits) waiting.push_back(odometryAt(mrpt::Clock::fromDouble(*odometry.time())));
}

mrpt::obs::CObservation::Ptr ObservationReader::Impl::odometryAt(mrpt::Clock::time_point t) {
  odometry_waits = false;
  auto reading = mrpt::obs::CObservationOdometry::Create();
  const Pose2 pose = odometry.pose();
  reading->odometry = {pose.x, pose.y, pose.yaw};
  reading->timestamp = t;
  return reading;
}

std::string ObservationReader::Impl::problemWith(mrpt::obs::CObservation& observation) const {
  const auto t = toSeconds(observation.timestamp);
  if (!t || !plausibleTime(*t)) return "invalid time stamp";
  if (auto problem = problemOf(observation); !problem.empty()) return problem;
  auto* images = dynamic_cast<CObservation3DRangeScan*>(&observation);
  if (!images) return "";
  if (!missingExternalFile(*images, image_folder).empty()) return "image missing";
  try {
    loadImages(*images);
    if (images->hasIntensityImage) images->intensityImage.forceLoad();
  } catch (const std::exception& error) {
    return "image unreadable: " + firstLine(error);
  }
  return "";
}

void ObservationReader::Impl::take(const mrpt::serialization::CSerializable::Ptr& object) {
  if (const auto actions = std::dynamic_pointer_cast<mrpt::obs::CActionCollection>(object))
    takeActions(*actions);
  else if (const auto frame = std::dynamic_pointer_cast<mrpt::obs::CSensoryFrame>(object))
    waiting.insert(waiting.end(), frame->begin(), frame->end());
  else if (const auto single = std::dynamic_pointer_cast<mrpt::obs::CObservation>(object))
    waiting.push_back(single);
  else
    ++skipped[object ? shortClassName(object->GetRuntimeClass()->className) + ": not used" : "empty object"];
}

ObservationReader::ObservationReader(const std::filesystem::path& file)
    : impl_(std::make_unique<Impl>(file)) {}
ObservationReader::~ObservationReader() = default;
ObservationReader::ObservationReader(ObservationReader&&) noexcept = default;
ObservationReader& ObservationReader::operator=(ObservationReader&&) noexcept = default;

mrpt::obs::CObservation::Ptr ObservationReader::next() {
  while (true) {
    while (!impl_->waiting.empty()) {
      auto observation = std::move(impl_->waiting.front());
      impl_->waiting.pop_front();
      if (!observation) continue;  // MRPT could not make it
      const auto problem = impl_->problemWith(*observation);
      if (problem.empty()) {
        if (!impl_->odometry_waits) return observation;
        impl_->waiting.push_front(observation);
        return impl_->odometryAt(observation->timestamp);
      }
      ++impl_->skipped[shortClassName(observation->GetRuntimeClass()->className) + ": " + problem];
    }
    const auto item = impl_->source.next();
    if (!item) return nullptr;
    if (item->object)
      impl_->take(item->object);
    else
      ++impl_->skipped[item->reason];
  }
}

Outcome<Frame> ObservationReader::frameOf(CObservation3DRangeScan& observation) const {
  return toFrame(observation, impl_->image_folder);
}

bool ObservationReader::isRegistered(const CObservation3DRangeScan& observation) {
  if (!observation.hasIntensityImage || !observation.hasRangeImage) return false;
  const auto& image = observation.intensityImage;
  const auto& ranges = observation.rangeImage;
  return depthIsRegistered(
      observation,
      cameraForImage(observation.cameraParamsIntensity, static_cast<int>(image.getWidth()),
                     static_cast<int>(image.getHeight())),
      cameraForImage(observation.cameraParams, static_cast<int>(ranges.cols()),
                     static_cast<int>(ranges.rows())));
}

double ObservationReader::progress() const {
  return impl_->source.progress();
}
const std::map<std::string, int>& ObservationReader::skipped() const {
  return impl_->skipped;
}
const std::string& ObservationReader::truncation() const {
  return impl_->source.truncation();
}

}  // namespace roomgraph
