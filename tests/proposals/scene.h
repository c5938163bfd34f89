// SPDX-License-Identifier: BSD-3-Clause
// Ray-cast scenes of solids with depth, labels and shading for the proposal tests.
#pragma once

#include <cmath>
#include <limits>
#include <vector>

#include "gather_evidence.h"
#include "roomgraph/geometry/ground.h"
#include "roomgraph/observations/detection.h"
#include "roomgraph/observations/frame.h"
#include "roomgraph/observations/object_database.h"
#include "roomgraph/proposals/shape_generator.h"

namespace roomgraph::test {

/// Upright solid in the world: an axis-aligned part of an object frame, or a cylinder.
struct Solid {
  Pose3 world_from_solid = Pose3::Identity();
  bool round = false;
  Eigen::Vector3d low{0, 0, 0}, high{1, 1, 1};  ///< box; a cylinder has radius high.x() and height high.z()
  int object = 0;                               ///< label, 0: background
};

/// Nearest positive ray parameter of p + t d with the solid, infinity when it misses.
inline double hit(const Solid& s, const Eigen::Vector3d& p, const Eigen::Vector3d& d) {
  double enter = 1e-9, leave = std::numeric_limits<double>::infinity();
  const auto slab = [&](double low, double high, int axis) {
    double a = (low - p[axis]) / d[axis], b = (high - p[axis]) / d[axis];
    if (std::isnan(a) || std::isnan(b)) a = b = 0;
    enter = std::max(enter, std::min(a, b));
    leave = std::min(leave, std::max(a, b));
  };
  slab(s.low.z(), s.high.z(), 2);
  if (!s.round) {
    slab(s.low.x(), s.high.x(), 0);
    slab(s.low.y(), s.high.y(), 1);
  } else {
    const double a = d.head<2>().squaredNorm(), b = p.head<2>().dot(d.head<2>());
    const double c = p.head<2>().squaredNorm() - s.high.x() * s.high.x(), root = b * b - a * c;
    if (root < 0) return std::numeric_limits<double>::infinity();
    enter = std::max(enter, (-b - std::sqrt(root)) / a);
    leave = std::min(leave, (-b + std::sqrt(root)) / a);
  }
  return enter < leave ? enter : std::numeric_limits<double>::infinity();
}

/// A world of solids on (or without) a floor, seen by ray casting: independent of the library's projections.
struct Scene {
  std::vector<Solid> solids;
  bool floor = true;
  Pose3 world_from_camera = Pose3::Identity();
  PinholeCamera camera{320, 240, 262.5, 262.5, 159.5, 119.5, {}};
  double max_range = 5;

  /// Camera at (0, 0, height) looking along world x, pitched down and rolled (rad).
  void lookAhead(double height, double pitch_down, double roll = 0) {
    world_from_camera = poseFromYpr(0, 0, height, 0, pitch_down, roll);
    world_from_camera.linear() = world_from_camera.linear() * bodyFromOptical();
  }

  void addBox(double x, double y, double yaw, double width, double depth, double bottom, double top,
              int object) {
    Solid s;
    s.world_from_solid = toPose3(Pose2{x, y, yaw});
    s.low = {-depth / 2, -width / 2, bottom};
    s.high = {depth / 2, width / 2, top};
    s.object = object;
    solids.push_back(s);
  }
  void addCylinder(double x, double y, double radius, double height, int object) {
    Solid s;
    s.world_from_solid = toPose3(Pose2{x, y, 0});
    s.round = true;
    s.low = {0, 0, 0};
    s.high = {radius, radius, height};
    s.object = object;
    solids.push_back(s);
  }
  /// Seat in front, back rest behind, arm rests at both sides; outer size width x depth x height.
  void addSofa(double x, double y, double yaw, double width, double depth, double height, int object) {
    const auto part = [&](double x0, double x1, double y0, double y1, double top) {
      Solid s;
      s.world_from_solid = toPose3(Pose2{x, y, yaw});
      s.low = {x0, y0, 0.02};
      s.high = {x1, y1, top};
      s.object = object;
      solids.push_back(s);
    };
    part(-depth / 2, depth / 2, -width / 2, width / 2, 0.43);
    part(-depth / 2, -depth / 2 + 0.22, -width / 2, width / 2, height);
    part(-depth / 2, depth / 2, -width / 2, -width / 2 + 0.18, 0.62);
    part(-depth / 2, depth / 2, width / 2 - 0.18, width / 2, 0.62);
  }

  /// Depth image; `labels`, when given, gets the object of every pixel (-1: nothing in range).
  Frame render(cv::Mat* labels = nullptr) const {
    Frame frame;
    frame.camera = camera;
    frame.depth = cv::Mat(camera.height, camera.width, CV_32FC1, cv::Scalar(0));
    cv::Mat seen(camera.height, camera.width, CV_32SC1, cv::Scalar(-1));
    for (int v = 0; v < camera.height; ++v)
      for (int u = 0; u < camera.width; ++u) castPixel(u, v, frame.depth, seen);
    if (labels) *labels = seen;
    return frame;
  }

 private:
  void castPixel(int u, int v, cv::Mat& depth, cv::Mat& seen) const {
    const Eigen::Vector3d origin = world_from_camera.translation();
    const Eigen::Vector3d d = world_from_camera.linear() * camera.ray(u, v);
    double nearest = floor && d.z() < 0 ? -origin.z() / d.z() : std::numeric_limits<double>::infinity();
    int object = 0;
    for (const Solid& s : solids) {
      const Pose3 inverse = s.world_from_solid.inverse();
      const double t = hit(s, inverse * origin, inverse.linear() * d);
      if (t < nearest) nearest = t, object = s.object;
    }
    if (nearest > max_range) return;  // the ray has z = 1: its parameter is the depth
    depth.at<float>(v, u) = static_cast<float>(nearest);
    seen.at<int>(v, u) = object;
  }
};

/// A robot's camera, looking a little down.
inline Scene sceneAhead() {
  Scene scene;
  scene.lookAhead(0.8, 0.2);
  return scene;
}

/// Gray image of a depth image: every surface as bright as it is turned to a light, other objects differ a
/// little. Creases and outlines become edges.
inline cv::Mat shaded(const Frame& frame, const cv::Mat& labels) {
  cv::Mat gray(frame.depth.rows, frame.depth.cols, CV_8UC1, cv::Scalar(90));
  const Eigen::Vector3d light = Eigen::Vector3d(0.5, -0.8, -0.33).normalized();
  for (int v = 0; v + 1 < gray.rows; ++v)
    for (int u = 0; u + 1 < gray.cols; ++u) {
      const float z = frame.depth.at<float>(v, u), right = frame.depth.at<float>(v, u + 1),
                  below = frame.depth.at<float>(v + 1, u);
      if (!(z > 0) || !(right > 0) || !(below > 0)) continue;
      const Eigen::Vector3d p = frame.camera.backProject(u, v, z);
      const Eigen::Vector3d n = (frame.camera.backProject(u, v + 1, below) - p)
                                    .cross(frame.camera.backProject(u + 1, v, right) - p)
                                    .normalized();
      gray.at<unsigned char>(v, u) =
          static_cast<unsigned char>(110 + 90 * n.dot(light) + 12 * (labels.at<int>(v, u) % 4));
    }
  return gray;
}

/// The box of an object's pixels.
inline Detection detectionOf(int object, const cv::Mat& labels, const std::string& class_name) {
  Detection d;
  d.class_name = class_name;
  d.score = 0.9;
  d.box = {1e9, 1e9, 0, 0};
  for (int v = 0; v < labels.rows; ++v)
    for (int u = 0; u < labels.cols; ++u)
      if (labels.at<int>(v, u) == object)
        d.box = {std::min<double>(d.box.u_min, u), std::min<double>(d.box.v_min, v),
                 std::max<double>(d.box.u_max, u + 1), std::max<double>(d.box.v_max, v + 1)};
  return d;
}

inline const char* kObjects = R"(
[swivel_chair]
labels = chair
shape = cylinder
width_m = 0.62
depth_m = 0.62
height_m = 0.95
width_sigma_m = 0.08
depth_sigma_m = 0.08
symmetry = 0
[sofa]
labels = couch
width_m = 1.8
depth_m = 0.88
height_m = 0.82
width_sigma_m = 0.3
depth_sigma_m = 0.1
front = high_back
[door]
labels = door
shape = planar
width_m = 0.9
depth_m = 0.06
height_m = 2.05
symmetry = 2
[person]
labels = person
shape = cylinder
width_m = 0.5
depth_m = 0.5
height_m = 1.7
symmetry = 0
landmark = false
)";

inline const ObjectDatabase& database() {
  static const ObjectDatabase db = ObjectDatabase::fromText(kObjects);
  return db;
}

/// What a shape generator makes of a detection.
template <class Generator>
std::vector<PlacedShape> hypotheses(const BoxEvidence& evidence) {
  return Generator().generate(evidence, GeneratorLimits{});
}

}  // namespace roomgraph::test
