// SPDX-License-Identifier: BSD-3-Clause
// Odometry front ends: wheels, visual tracking and scan matching, each predicting for the others.
#pragma once

#include <array>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "roomgraph/estimation/motion.h"
#include "roomgraph/estimation/movement_agreement.h"
#include "roomgraph/estimation/sensor_clocks.h"
#include "roomgraph/estimation/wheel_calibration.h"
#include "roomgraph/datasets/calibration_file.h"
#include "roomgraph/datasets/record_stream.h"
#include "roomgraph/pipeline/options.h"
#include "roomgraph/pipeline/stages.h"

namespace roomgraph {

class ScansAhead;

/// In the order of kMotionSensors; nothing where there is no such sensor.
using LabelsOfSensors = std::array<std::optional<std::string>, kMotionSensors.size()>;

/// Sensor records -> movement of the robot. Owns the trajectories of the three sources, each in its own
/// frame; every source predicts for the others.
class FrontEnds {
 public:
  /// Both outlive the front ends.
  FrontEnds(const Stages& stages, const Options& options);
  ~FrontEnds();

  const Motion& motion() const { return motion_; }
  /// What wheels err by, as far as images or scans told.
  const WheelCalibration& wheelCalibration() const { return calibration_; }
  /// What takes it out, as in a calibration file.
  WheelCorrection wheelCorrection() const;
  /// Whether the sensors measured the same movements.
  const MovementAgreement& agreement() const { return agreement_; }
  /// Whether they did so at the same times.
  const SensorClocks& clocks() const { return clocks_; }
  /// Of the sensors that gave something; that of wheels is empty.
  const LabelsOfSensors& labels() const { return labels_; }

  /// Whether camera and lidar have one label, which names neither.
  bool shareLabel() const;

  /// False when the stamp does not come after the last one.
  bool add(const OdometryReading& reading);
  /// `people`: image regions that are not used, px.
  TrackingResult track(const Frame& frame, const std::vector<Box2>& people);
  ScanMatch match(const Scan& scan);
  /// What can be known of a record before its turn, on the thread that reads ahead: all records in order.
  void foresee(const Record& record);

  /// Loop closures found in images since the last call, between robots.
  std::vector<RelativePose> takeImageClosures();
  /// Asks the scans, then the images, whether a proposed closure between robots is right; refines it.
  std::optional<RelativePose> verify(const RelativePose& proposed);
  /// Takes over what the front ends refined since: for the final estimate.
  void refine();
  /// Nothing more comes, and no closure will be verified: what images showed is given up.
  void releaseImages();
  /// No loop of scans will be searched: the local maps kept for that are given up.
  void releaseScans();

 private:
  void toRobot(RelativePose& of_camera) const;
  /// The robot drives on a floor: known of all its poses from now on.
  void setPlanar();
  void compareSensors();
  void compareClocks();
  void calibrateWheels(const MotionSource& teacher, std::optional<double>& taught_t);

  const Stages& stages_;
  const Options& options_;
  Motion motion_;               ///< of wheels without their errors
  MotionSource wheels_as_read_;  ///< what predicts: scans may be matched before their turn, and images would follow what they taught
  WheelCalibration calibration_;
  std::optional<Pose2> wheels_;          ///< the last pose in motion_
  std::optional<double> taught_by_lidar_, taught_by_camera_;  ///< until then wheels were compared with them
  MovementAgreement agreement_;
  SensorClocks clocks_;
  LabelsOfSensors labels_;
  std::optional<double> compared_t_;  ///< until then sensors were compared
  double predicted_t_ = -std::numeric_limits<double>::infinity();  ///< of the last image whose place was only predicted
  std::unique_ptr<ScansAhead> scans_ahead_;
  std::optional<double> last_frame_t_, last_scan_t_;
  Pose3 robot_from_camera_ = Pose3::Identity();
  bool mounted_ = false;  ///< the camera's place on the robot is known
};

}  // namespace roomgraph
