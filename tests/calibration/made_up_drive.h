// SPDX-License-Identifier: BSD-3-Clause
// A drive through a room of known shape with sensors in known places, as evidence without images.
#pragma once

#include <cmath>
#include <random>

#include "calibration_problem.h"
#include "roomgraph/geometry/degree.h"
#include "scan_walls.h"
#include "sensor_model.h"

namespace roomgraph::test {

struct DriveNoise {
  double lidar_m = 0, lidar_rad = 0, range_m = 0,
         depth_per_m2 = 0;              ///< standard deviations; the last times squared depth
  double wheels_m = 0, wheels_rad = 0;  ///< per root of a metre, per root of a radian
  double step_rad = 0, step_m = 0;
  double board_rad = 0, board_m = 0;  ///< of its tilt and its distance; a fifth of that about its normal and aside
};

struct DriveOptions {
  double seconds = 30;
  bool turns = true, lidar = true, wheels = true, views = true, steps = true, board = false;
  DriveNoise noise;
  unsigned seed = 1;
};

/// Parameters of sensors on a robot, all different from "nothing".
inline ParameterVector trueParameters() {
  ParameterVector p = ParameterVector::Zero();
  p.segment<3>(kLidarX) << 0.12, -0.03, 4 * kDegree;
  p.segment<6>(kCameraX) << 0.08, 0.04, 0.62, -3 * kDegree, 9 * kDegree, 1.5 * kDegree;
  p[kCameraTime] = 0.03;
  p[kWheelTime] = -0.025;
  p[kWheelScale] = 1.03;
  p[kTurnScale] = 0.97;
  p[kHeadingDrift] = 0.006;
  p[kDepthScale] = 1.015;
  p[kDepthBias] = -0.012;
  return p;
}

/// What was believed before: off by 5 cm and 5 degrees, no time offsets, wheels and depth as they come.
inline ParameterVector wrongParameters() {
  ParameterVector p = trueParameters();
  p.segment<3>(kLidarX) += Eigen::Vector3d(-0.05, 0.04, -5 * kDegree);
  p.segment<6>(kCameraX) << 0.03, 0.0, 0.67, 2 * kDegree, 5 * kDegree, -2 * kDegree;
  p[kCameraTime] = p[kWheelTime] = p[kHeadingDrift] = p[kDepthBias] = 0;
  p[kWheelScale] = p[kTurnScale] = p[kDepthScale] = 1;
  return p;
}

class MadeUpDrive {
 public:
  static constexpr double kLidarZ = 0.3, kStep_s = 0.002;

  explicit MadeUpDrive(const DriveOptions& options, const ParameterVector& truth = trueParameters())
      : options_(options), truth_(truth), random_(options.seed) {
    drive();
  }

  RecordingEvidence evidence() {
    RecordingEvidence out;
    if (options_.lidar) addLidar(out);
    if (options_.wheels) addWheels(out);
    if (options_.views) addViews(out);
    if (options_.steps) addSteps(out);
    if (options_.board) addBoards(out);
    return out;
  }
  CalibrationTask task(const ParameterVector& before = wrongParameters()) {
    CalibrationTask out;
    out.evidence.push_back(evidence());
    out.before = before;
    out.lidar_z_m = kLidarZ;
    return out;
  }
  /// World from robot at a true time.
  Pose2 robotAt(double t) const {
    const double at = (t + kBefore_s) / kStep_s;
    const auto i = std::min(path_.size() - 2, static_cast<std::size_t>(std::max(0.0, at)));
    const Pose2 step = path_[i].inverse() * path_[i + 1];
    const double share = at - static_cast<double>(i);
    return path_[i] * Pose2{share * step.x, share * step.y, share * step.yaw};
  }

 private:
  static constexpr double kBefore_s = 1;

  // Speed and turn rate change smoothly and never repeat; the robot stays within a room of 8 m by 6 m.
  void drive() {
    Pose2 pose{-1.5, -1, 0.3};
    for (double t = -kBefore_s; t < options_.seconds + kBefore_s; t += kStep_s) {
      path_.push_back(pose);
      speeds_.push_back(0.25 + 0.15 * std::sin(0.7 * t));
      const double turn = options_.turns ? 0.25 + 0.5 * std::sin(0.9 * t + 1) + 0.2 * std::sin(2.3 * t) : 0;
      const double v = options_.turns ? speeds_.back() : 0.4 * speeds_.back();
      pose = pose * Pose2{v * kStep_s, 0, turn * kStep_s};
    }
  }
  double normal(double sigma) { return sigma * deviate_(random_); }
  Pose2 lidarOnRobot() const { return {truth_[kLidarX], truth_[kLidarY], truth_[kLidarYaw]}; }

  // Distance along a ray from inside the room.
  static double castWalls(const Eigen::Vector2d& from, const Eigen::Vector2d& direction) {
    double out = 1e9;
    for (int axis = 0; axis < 2; ++axis) {
      const double limit = (axis == 0 ? 4 : 3) * (direction[axis] > 0 ? 1 : -1);
      if (std::abs(direction[axis]) > 1e-9) out = std::min(out, (limit - from[axis]) / direction[axis]);
    }
    return out;
  }

  void addLidar(RecordingEvidence& out) {
    out.lidar.emplace_back();
    for (double t = 0; t <= options_.seconds; t += 0.1) {
      const Pose2 lidar = robotAt(t) * lidarOnRobot();
      const auto& n = options_.noise;
      out.lidar.back().add(
          t, {lidar.x + normal(n.lidar_m), lidar.y + normal(n.lidar_m), lidar.yaw + normal(n.lidar_rad)});
      std::vector<Eigen::Vector2d> returns;
      for (int i = 0; i < 360; ++i) {
        const double angle = i * kDegree;
        const Eigen::Vector2d ray(std::cos(angle), std::sin(angle));
        const double range =
            castWalls({lidar.x, lidar.y}, Eigen::Rotation2Dd(lidar.yaw) * ray) + normal(n.range_m);
        returns.emplace_back(range * ray);
      }
      out.scans.push_back({t, findScanWalls(returns)});
    }
    out.lidar.back().smooth();
  }

  // The inverse of correctedMovement(), in steps so small that order does not matter.
  void addWheels(RecordingEvidence& out) {
    out.wheels.emplace_back();
    Pose2 read;
    double next = 0;
    for (double t = 0; t <= options_.seconds; t += kStep_s) {
      if (t >= next - 1e-9) {
        out.wheels.back().add(t - truth_[kWheelTime], read);
        next += 0.05;
      }
      const Pose2 step = robotAt(t).inverse() * robotAt(t + kStep_s);
      const double length = std::hypot(step.x, step.y);
      const double turned = (step.yaw - truth_[kHeadingDrift] * length) / truth_[kTurnScale];
      read = read * Pose2{length / truth_[kWheelScale] + normal(options_.noise.wheels_m * std::sqrt(length)),
                          0, turned + normal(options_.noise.wheels_rad * std::sqrt(std::abs(turned)))};
    }
    out.wheels.back().smooth();
  }

  // Depth as it is recorded: what the correction turns into the true one.
  double recorded(double z) {
    return (z - truth_[kDepthBias]) / truth_[kDepthScale] + normal(options_.noise.depth_per_m2 * z * z);
  }

  void addViews(RecordingEvidence& out) {
    const Eigen::Matrix3d mounted = cameraRotation(truth_.data());
    const Eigen::Vector3d place = cameraPlace(truth_.data());
    for (double t = 0.5; t < options_.seconds - 0.5; t += 0.25) {
      const Pose2 robot = robotAt(t);
      const Eigen::Matrix3d world_from_camera = toPose3(robot).linear() * mounted;
      const Eigen::Vector3d camera = toPose3(robot) * place;
      DepthView view;
      view.t = t - truth_[kCameraTime];
      for (int v = -22; v <= 22; v += 2)
        for (int u = -28; u <= 28; ++u) {
          const Eigen::Vector3d ray(u / 50.0, v / 50.0, 1), in_world = world_from_camera * ray;
          const double to_wall = castWalls(camera.head<2>(), in_world.head<2>());
          const double to_floor = in_world.z() < 0 ? -camera.z() / in_world.z() : 1e9;
          if (std::min(to_wall, to_floor) > 5) continue;
          const double z = recorded(std::min(to_wall, to_floor));
          if (to_floor < to_wall) {
            if (u % 14 == 0 && v % 4 == 0) view.floor.push_back({z * ray, ray});
            continue;
          }
          const double height = camera.z() + to_wall * in_world.z();
          if (height > kLidarZ + 0.5) continue;
          const Eigen::Vector3d hit = camera + to_wall * in_world;
          const bool across = std::abs(std::abs(hit.x()) - 4) < 1e-6;
          const Eigen::Vector3d n = across ? Eigen::Vector3d(hit.x() > 0 ? -1 : 1, 0, 0)
                                           : Eigen::Vector3d(0, hit.y() > 0 ? -1 : 1, 0);
          view.upright.push_back({{z * ray, ray}, world_from_camera.transpose() * n});
        }
      out.views.push_back(view);
    }
  }

  void addSteps(RecordingEvidence& out) {
    Pose3 mounted = Pose3::Identity();
    mounted.linear() = cameraRotation(truth_.data());
    mounted.translation() = cameraPlace(truth_.data());
    constexpr double kSpacing_s = 0.3, kDepth_m = 2.5;
    for (double t = 0.5; t + kSpacing_s < options_.seconds - 0.5; t += kSpacing_s) {
      Pose3 moved = (toPose3(robotAt(t)) * mounted).inverse() * toPose3(robotAt(t + kSpacing_s)) * mounted;
      const auto& n = options_.noise;
      moved.translation() /= truth_[kDepthScale] + truth_[kDepthBias] / kDepth_m;
      moved.translation() += Eigen::Vector3d(normal(n.step_m), normal(n.step_m), normal(n.step_m));
      moved.linear() *= expSO3({normal(n.step_rad), normal(n.step_rad), normal(n.step_rad)});
      out.steps.push_back({t - truth_[kCameraTime], t + kSpacing_s - truth_[kCameraTime], moved, kDepth_m});
    }
  }

  // A board of 9 by 6 corners, 4 cm apart, before the wall at y = -3; seen as a whole from up to 4 m.
  void addBoards(RecordingEvidence& out) {
    Pose3 mounted = Pose3::Identity(), world_from_board = Pose3::Identity();
    mounted.linear() = cameraRotation(truth_.data());
    mounted.translation() = cameraPlace(truth_.data());
    world_from_board.linear() << -1, 0, 0, 0, 0, -1, 0, -1, 0;
    world_from_board.translation() << -1, -2.9, 0.5;
    for (double t = 0.5; t < options_.seconds - 0.5; t += 0.25) {
      const Pose3 board = (toPose3(robotAt(t)) * mounted).inverse() * world_from_board;
      BoardView view{.t = t - truth_[kCameraTime], .camera_from_board = board, .depth = DepthPatch{}};
      view.turn_covariance.diagonal() << 1e-5, 1e-5, 4e-7;
      view.place_covariance.diagonal() << 2e-7, 2e-7, 5e-6;
      bool whole = true;
      for (int row = 0; row < 6; ++row)
        for (int column = 0; column < 9; ++column) {
          const Eigen::Vector3d corner = board * Eigen::Vector3d(0.04 * (column - 4), 0.04 * (row - 2.5), 0);
          const Eigen::Vector3d ray = corner / corner.z();
          whole &= corner.z() > 0.4 && corner.z() < 4 && std::abs(ray.x()) < 0.56 && std::abs(ray.y()) < 0.44;
          view.depth->point += recorded(corner.z()) * ray / 54;
          view.depth->ray += ray / 54;
        }
      if (!whole) continue;
      const auto& n = options_.noise;
      view.camera_from_board.translation() +=
          Eigen::Vector3d(normal(n.board_m / 5), normal(n.board_m / 5), normal(n.board_m));
      view.camera_from_board.linear() *= expSO3({normal(n.board_rad), normal(n.board_rad), normal(n.board_rad / 5)});
      out.boards.push_back(view);
    }
  }

  DriveOptions options_;
  ParameterVector truth_;
  std::mt19937 random_;
  std::normal_distribution<double> deviate_;
  std::vector<Pose2> path_;
  std::vector<double> speeds_;
};

}  // namespace roomgraph::test
