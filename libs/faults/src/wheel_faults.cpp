// SPDX-License-Identifier: BSD-3-Clause
// Odometry summed up again from those increments in which the wheels turn.
#include "wheel_faults.h"

#include <mrpt/obs/CObservationOdometry.h>

#include <cmath>

namespace roomgraph {
namespace {

bool isFinite(const Pose2& pose) {
  return std::isfinite(pose.x) && std::isfinite(pose.y) && std::isfinite(pose.yaw);
}

}  // namespace

Pose2 StandingWheels::report(const Pose2& recorded, bool stand) {
  if (!begun_) reported_ = recorded;
  if (begun_ && stand)
    differs_ = true;
  else if (begun_)
    reported_ = differs_ ? reported_ * (recorded_.inverse() * recorded) : recorded;
  begun_ = true;
  recorded_ = recorded;
  return reported_;
}

PassingRecords LiftedWheelsFault::pass(PassingRecord record) {
  auto* reading = dynamic_cast<mrpt::obs::CObservationOdometry*>(record.observation.get());
  if (!reading) return one(std::move(record));
  const Pose2 recorded{reading->odometry.x(), reading->odometry.y(), reading->odometry.phi()};
  if (!isFinite(recorded)) return one(std::move(record));
  StandingWheels& wheels = wheels_[record.label()];
  const bool stand = window_.contains(record.t);
  const Pose2 reported = wheels.report(recorded, stand);
  if (wheels.differs()) {
    reading->odometry = {reported.x, reported.y, reported.yaw};
    reading->hasEncodersInfo = false;
    if (stand) reading->velocityLocal = {0, 0, 0};
    changed(record);
  }
  return one(std::move(record));
}

PassingRecords KidnapFault::pass(PassingRecord record) {
  const bool inside = window_.contains(record.t);
  if (inside) count(record);
  PassingRecords left = carried_.pass(std::move(record));
  return inside ? PassingRecords{} : std::move(left);
}

}  // namespace roomgraph
