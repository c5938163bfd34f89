// SPDX-License-Identifier: BSD-3-Clause
// Observations of MRPT made from messages of ROS.
#pragma once

#include <mrpt/core/Clock.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservationIMU.h>
#include <mrpt/obs/CObservationOdometry.h>

#include "messages.h"

namespace roomgraph::bags {

/// Time in MRPT's clock, which has steps of 100 ns, from the Unix epoch; and back.
mrpt::Clock::time_point toMrptTime(std::int64_t t_ns);
std::int64_t toNanoseconds(mrpt::Clock::time_point t);

/// From the stamp of a scan, which is that of its first beam, to the middle of the sweep.
std::int64_t halfSweepNs(const LaserScanMessage& scan);

/// A scan without pose and label: MRPT's lies symmetrically about the sensor's x axis; `yaw` gets the angle
/// from the message's axis to that, rad. Throws BadMessage: no beams, impossible angles.
mrpt::obs::CObservation2DRangeScan::Ptr makeScan(const LaserScanMessage& message, double& yaw);

mrpt::obs::CObservationOdometry::Ptr makeOdometry(const Pose3& odom_from_robot);
mrpt::obs::CObservationOdometry::Ptr makeOdometry(const OdometryMessage& message);

/// The odometry of another frame that sits on the same body.
OdometryMessage movedTo(const OdometryMessage& odometry, const Pose3& child_from_other);

/// Throws BadMessage when it measures nothing.
mrpt::obs::CObservationIMU::Ptr makeImu(const ImuMessage& message);

}  // namespace roomgraph::bags
