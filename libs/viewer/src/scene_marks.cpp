// SPDX-License-Identifier: BSD-3-Clause
// Ribbons, discs and texts for what is marked in a scene.
#include "scene_marks.h"

#include <mrpt/opengl/CText.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "roomgraph/rendering/scene_parts.h"
#include "roomgraph/rendering/triangle_set.h"

namespace roomgraph {
namespace {

constexpr double kFrameLift = 0.05;  ///< above the outline that a landmark has already
constexpr double kMarkLift = 0.035;  ///< above floor and path
constexpr int kName_px = 18;
constexpr double kChi2Of95 = 5.991;  ///< two degrees of freedom

/// A bar that is seen from every side, whichever way it points.
void addBar(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double width,
            const palette::TColor& color, TriangleSet& mesh) {
  const Eigen::Vector3d along = (to - from).normalized();
  const Eigen::Vector3d helper =
      std::abs(along.z()) < 0.9 ? Eigen::Vector3d::UnitZ() : Eigen::Vector3d::UnitX();
  const Eigen::Vector3d u = along.cross(helper).normalized() * width / 2, v = along.cross(u);
  const Eigen::Vector3d corners[] = {u + v, v - u, -u - v, u - v};
  for (int i = 0; i < 4; ++i) {
    const Eigen::Vector3d &a = corners[i], &b = corners[(i + 1) % 4];
    mesh.polygon({from + a, from + b, to + b, to + a}, color);
  }
}

std::optional<Eigen::Vector3d> placeAt(const std::vector<StampedPose>& path, double t) {
  const auto after = std::partition_point(path.begin(), path.end(),
                                          [&](const StampedPose& pose) { return pose.t < t - 1e-3; });
  if (after == path.end()) return std::nullopt;
  return after->pose.translation();
}

}  // namespace

void addPoints(const std::vector<Eigen::Vector3f>& points, double size, const palette::TColor& color,
               COpenGLScene& scene) {
  TriangleSet mesh;
  for (const auto& point : points) mesh.disc(point.cast<double>(), size, color, 6);
  scene.insert(mesh.object("points"));
}

void addFrame(const ObjectShape& shape, const Pose3& world_from_object, double width,
              const palette::TColor& color, COpenGLScene& scene) {
  const auto base = footprint(shape, 24);
  const std::size_t upright = shape.kind == ShapeKind::kCylinder ? base.size() / 4 : 1;
  const auto corner = [&](std::size_t i, double z) {
    const Eigen::Vector2d& at = base[i % base.size()];
    return Eigen::Vector3d(world_from_object * Eigen::Vector3d(at.x(), at.y(), z + kFrameLift));
  };
  TriangleSet mesh;
  for (std::size_t i = 0; i < base.size(); ++i) {
    for (const double z : {0.0, shape.height}) addBar(corner(i, z), corner(i + 1, z), width, color, mesh);
    if (i % upright == 0) addBar(corner(i, 0), corner(i, shape.height), width, color, mesh);
  }
  scene.insert(mesh.object("frame"));
}

void addKeyPoses(const std::vector<StampedPose>& poses, bool planar, double size,
                 const palette::TColor& color, COpenGLScene& scene) {
  TriangleSet mesh;
  for (const auto& [t, pose] : poses) {
    Eigen::Vector3d at = pose.translation();
    if (planar) at.z() = 0;
    at.z() += kMarkLift;
    const double yaw = planarPart(pose).yaw;
    mesh.disc(at, size / 2, color, 12);
    const Eigen::Vector3d nose = at + size * Eigen::Vector3d(std::cos(yaw), std::sin(yaw), 0);
    mesh.ribbon(at, nose, size / 3, color);
  }
  scene.insert(mesh.object("key poses"));
}

void addClosures(const std::vector<ShownClosure>& closures, const CSemanticMap& map, double width,
                 const palette::TColor& color, COpenGLScene& scene) {
  TriangleSet mesh;
  for (const auto& closure : closures) {
    const auto a = placeAt(map.world_from_robot, closure.t_a), b = placeAt(map.world_from_robot, closure.t_b);
    if (!a || !b) continue;
    const Eigen::Vector3d lift(0, 0, map.planar ? kMarkLift + 0.01 : 0);
    addBar(*a + lift, *b + lift, width, color, mesh);
  }
  scene.insert(mesh.object("closures"));
}

std::vector<Eigen::Vector2d> ellipse95(const Eigen::Vector2d& mean, const Eigen::Matrix2d& covariance,
                                       int sides) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(covariance);
  const Eigen::Vector2d radii = (kChi2Of95 * axes.eigenvalues().cwiseMax(0)).cwiseSqrt();
  std::vector<Eigen::Vector2d> points;
  for (int i = 0; i < sides; ++i) {
    const double angle = 2 * std::numbers::pi * i / sides;
    points.push_back(mean + axes.eigenvectors() *
                                Eigen::Vector2d(radii.x() * std::cos(angle), radii.y() * std::sin(angle)));
  }
  return points;
}

void addCovariance(const Landmark& landmark, double width, const palette::TColor& color,
                   COpenGLScene& scene) {
  std::vector<Eigen::Vector3d> rim;
  const double height = landmark.position.z() + landmark.shape.height + kMarkLift;
  for (const auto& at : ellipse95(landmark.position.head<2>(), landmark.covariance.topLeftCorner<2, 2>(), 32))
    rim.emplace_back(at.x(), at.y(), height);
  TriangleSet mesh;
  mesh.outline(rim, width, color);
  scene.insert(mesh.object("covariance " + std::to_string(landmark.id.value)));
}

namespace {

// MRPT's letters are ASCII: one question mark for each other character, in place of one for each byte.
std::string inAscii(const std::string& utf8) {
  std::string out;
  for (const char c : utf8) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x80) out += c;
    if (byte >= 0xC0) out += '?';
  }
  return out;
}

}  // namespace

void addName(const Landmark& landmark, COpenGLScene& scene) {
  auto text = mrpt::opengl::CText::Create(inAscii(inWords(landmark.class_name)) + " " + std::to_string(landmark.id.value));
  text->setFont("sans", kName_px);
  text->setColor_u8(palette::kInk);
  text->setLocation(landmark.position.x(), landmark.position.y(),
                    landmark.position.z() + landmark.shape.height + 2 * kMarkLift);
  text->setName("name " + std::to_string(landmark.id.value));
  scene.insert(text);
}

}  // namespace roomgraph
