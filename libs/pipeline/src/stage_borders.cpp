// SPDX-License-Identifier: BSD-3-Clause
// Checks of records, boxes, measurements, poses, places and covariances.
#include "stage_borders.h"

#include <Eigen/Cholesky>
#include <cmath>
#include <cstdio>

#include "roomgraph/core/errors.h"
#include "roomgraph/geometry/plausible_pose.h"

namespace roomgraph {
namespace {

constexpr double kPoseRounding = 1e-6;        // of an element of a rotation matrix
constexpr double kCovarianceRounding = 1e-6;  // of its largest element
constexpr double kProbabilityRounding = 1e-6;
constexpr double kLargestObject_m = 1000;

bool isProbability(double value) {
  return value >= 0 && value <= 1 + kProbabilityRounding;
}

bool isSizeOfImage(const cv::Mat& image, const PinholeCamera& camera) {
  return image.empty() || (image.cols == camera.width && image.rows == camera.height);
}

std::string problemIn(const Frame& frame) {
  const PinholeCamera& camera = frame.camera;
  const bool finite = std::isfinite(camera.fx) && std::isfinite(camera.fy) && std::isfinite(camera.cx) &&
                      std::isfinite(camera.cy);
  if (!finite || !camera.valid()) return "its camera has no intrinsics";
  for (const cv::Mat* image : {&frame.color, &frame.gray, &frame.depth})
    if (!isSizeOfImage(*image, camera)) return "an image has another size than its camera";
  return problemOf(frame.robot_from_camera, kPoseRounding);
}

std::string problemIn(const Scan& scan) {
  if (scan.ranges_m.size() != scan.valid.size()) return "as many ranges as flags are wanted";
  if (!std::isfinite(scan.angle_min_rad) || !std::isfinite(scan.angle_step_rad))
    return "the angles of its beams are not finite";
  for (std::size_t i = 0; i < scan.valid.size(); ++i)
    if (scan.valid[i] && !(std::isfinite(scan.ranges_m[i]) && scan.ranges_m[i] >= 0))
      return "a valid range is no distance";
  return problemOf(scan.robot_from_lidar, kPoseRounding);
}

std::string problemIn(const OdometryReading& reading) {
  return problemOf(reading.odom_from_robot);
}

std::string problemIn(const std::shared_ptr<CObservationDetections>& detections) {
  return detections ? "" : "there are none";
}

const char* kindOfRecord(const Record& record) {
  constexpr const char* kKinds[] = {"frame", "scan", "odometry", "detections"};
  return kKinds[record.index()];
}

}  // namespace

bool hasTime(const Record& record) {
  const auto* detections = std::get_if<std::shared_ptr<CObservationDetections>>(&record);
  return (!detections || *detections) && std::isfinite(timeOf(record));
}

std::string problemOfRecord(const Record& record) {
  const std::string problem = hasTime(record)
                                  ? std::visit([](const auto& value) { return problemIn(value); }, record)
                                  : "it has no time stamp";
  return problem.empty() ? "" : std::string(kindOfRecord(record)) + ": " + problem;
}

std::string problemOfDetection(const Detection& detection) {
  const Box2& box = detection.box;
  for (const double side : {box.u_min, box.v_min, box.u_max, box.v_max})
    if (!std::isfinite(side)) return "box is not finite";
  return isProbability(detection.score) ? "" : "score is not in [0, 1]";
}

std::string problemOfCovariance(const Eigen::Ref<const Eigen::MatrixXd>& covariance) {
  if (!covariance.allFinite()) return "covariance is not finite";
  const double largest = covariance.cwiseAbs().maxCoeff();
  if ((covariance - covariance.transpose()).cwiseAbs().maxCoeff() > kCovarianceRounding * largest)
    return "covariance is not symmetric";
  return covariance.llt().info() == Eigen::Success ? "" : "covariance is not positive definite";
}

std::string problemOfMeasurement(const ObjectMeasurement& measurement) {
  const Proposal& proposal = measurement.proposal;
  for (const double size : {proposal.shape.width, proposal.shape.depth, proposal.shape.height})
    if (!(size >= 0 && size < kLargestObject_m)) return "size is not in [0, 1000) m";
  if (!isProbability(measurement.confidence)) return "confidence is not in [0, 1]";
  for (const Eigen::Vector3d& information : {proposal.size_information, proposal.least_size_information})
    if (!information.allFinite() || information.minCoeff() < 0) return "size information is not a finite number from 0 on";
  if (!proposal.place_by_size.allFinite()) return "the dependence of the place on the size is not finite";
  if (auto problem = problemOf(proposal.camera_from_object, kPoseRounding); !problem.empty()) return problem;
  return problemOfCovariance(proposal.covariance);
}

std::string problemOfMovement(const RelativePose& movement) {
  if (!std::isfinite(movement.t_a) || !std::isfinite(movement.t_b)) return "time is not finite";
  if (auto problem = problemOf(movement.a_from_b, kPoseRounding); !problem.empty()) return problem;
  if (!movement.planar) return problemOfCovariance(movement.covariance);
  constexpr int kPlanar[] = {0, 1, 5};
  Eigen::Matrix3d of_x_y_yaw;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) of_x_y_yaw(i, j) = movement.covariance(kPlanar[i], kPlanar[j]);
  return problemOfCovariance(of_x_y_yaw);
}

void requirePose(const Pose3& world_from_robot, const Record& record) {
  const std::string problem = problemOf(world_from_robot, kPoseRounding);
  if (problem.empty()) return;
  char text[160];
  std::snprintf(text, sizeof text, "%s at t = %.3f s: localisation gives no pose: %s", kindOfRecord(record),
                timeOf(record), problem.c_str());
  throw RunError(text);
}

const LandmarkEstimates& sound(const LandmarkEstimates& landmarks) {
  for (const auto& [id, estimate] : landmarks)
    if (!(estimate.position.norm() < kFarthest_m) || !std::isfinite(estimate.yaw))
      throw RunError("landmark " + std::to_string(id.value) +
                     ": the optimisation of the graph gives no place");
  return landmarks;
}

bool isBroken(const char* stage, const std::string& problem, Reasons& reasons) {
  if (problem.empty()) return false;
  ++reasons[std::string(stage) + ", left out: " + problem];
  return true;
}

std::vector<Detection> withoutBroken(std::vector<Detection> boxes, Reasons& reasons) {
  std::erase_if(
      boxes, [&](const Detection& box) { return isBroken("detection", problemOfDetection(box), reasons); });
  return boxes;
}

std::vector<RelativePose> withoutBroken(std::vector<RelativePose> closures, Reasons& reasons) {
  std::erase_if(closures, [&](const RelativePose& closure) {
    return isBroken("loop closing", problemOfMovement(closure), reasons);
  });
  return closures;
}

}  // namespace roomgraph
