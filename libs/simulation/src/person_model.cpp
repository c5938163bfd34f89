// SPDX-License-Identifier: BSD-3-Clause
// Body parts, gait kinematics and position along the path.
#include "person_model.h"

#include <cmath>
#include <numbers>

#include "furniture_builders.h"
#include "mesh_file.h"

namespace roomgraph {
namespace {

// Proportions of an adult of 1.75 m.
constexpr double kHeight = 1.75, kHip = 0.90, kThigh = 0.43, kShank = 0.40, kShoulder = 0.52,
                 kUpperArm = 0.29;

using V = Eigen::Vector3d;

Mesh torso(const Person& p, MaterialList& materials) {
  MeshBuilder m(materials);
  m.use({"fabric", p.trousers, 0.5, 0}).ellipsoid({0, 0, 0.02}, {0.125, 0.175, 0.14});
  m.use({"fabric", p.shirt, 0.5, 1});
  m.ellipsoid({0.005, 0, 0.2}, {0.12, 0.165, 0.22});
  m.ellipsoid({0.0, 0, 0.4}, {0.13, 0.195, 0.2});
  m.capsule({-0.01, -0.15, 0.5}, {-0.01, 0.15, 0.5}, 0.075, 0.075);
  m.use({"paint", p.skin, 1, 0}).capsule({0, 0, 0.54}, {0.01, 0, 0.64}, 0.055, 0.05);
  m.ellipsoid({0.025, 0, 0.72}, {0.095, 0.078, 0.12});
  m.ellipsoid({0.12, 0, 0.705}, {0.018, 0.014, 0.025});
  for (const double side : {-1.0, 1.0}) m.ellipsoid({0.02, side * 0.079, 0.715}, {0.02, 0.012, 0.03});
  m.use({"leather", p.hair, 0.3, 0}).ellipsoid({-0.005, 0, 0.755}, {0.1, 0.088, 0.1});
  for (const double side : {-1.0, 1.0})
    m.use({"plain", {0.1, 0.08, 0.07}, 1, 0}).ellipsoid({0.108, side * 0.032, 0.74}, {0.012, 0.013, 0.008});
  return m.take();
}

Mesh thigh(const Person& p, MaterialList& materials) {
  MeshBuilder m(materials);
  m.use({"fabric", p.trousers, 0.5, 0}).capsule({0, 0, 0}, {0, 0, -kThigh}, 0.088, 0.06);
  return m.take();
}

Mesh shank(const Person& p, MaterialList& materials) {
  MeshBuilder m(materials);
  m.use({"fabric", p.trousers, 0.5, 0}).capsule({0, 0, 0}, {0, 0, -kShank + 0.05}, 0.06, 0.047);
  m.use({"leather", {0.1, 0.08, 0.07}, 0.3, 0})
      .roundedBox({0.06, 0, -kShank + 0.01}, {0.27, 0.095, 0.09}, 0.04);
  return m.take();
}

Mesh upperArm(const Person& p, MaterialList& materials) {
  MeshBuilder m(materials);
  m.use({"fabric", p.shirt, 0.5, 1}).capsule({0, 0, 0}, {0, 0, -kUpperArm}, 0.058, 0.045);
  return m.take();
}

Mesh foreArm(const Person& p, MaterialList& materials) {
  MeshBuilder m(materials);
  m.use({"fabric", p.shirt, 0.5, 1}).capsule({0, 0, 0}, {0, 0, -0.1}, 0.045, 0.042);
  m.use({"paint", p.skin, 1, 0}).capsule({0, 0, -0.1}, {0, 0, -0.24}, 0.038, 0.03);
  m.ellipsoid({0, 0, -0.31}, {0.025, 0.04, 0.075});
  return m.take();
}

Pose3 joint(const V& at, double pitch) {
  Pose3 out = Pose3::Identity();
  out.translate(at);
  out.rotate(Eigen::AngleAxisd(pitch, V::UnitY()));
  return out;
}

Mesh ofHeight(Mesh mesh, double height) {
  const auto box = mesh.bounds();
  const double scale = height / box.sizes().z();
  const Eigen::Vector3f bottom =
      Eigen::Vector3d(box.center().x(), box.center().y(), box.min().z()).cast<float>();
  for (auto& triangle : mesh.triangles)
    for (auto& corner : triangle.position) corner = (corner - bottom) * static_cast<float>(scale);
  return mesh;
}

}  // namespace

PersonModel::PersonModel(const Person& person, MaterialList& materials)
    : sits_(person.sits),
      scale_(person.height_m / kHeight),
      hip_m_(person.sits ? person.seat_height_m / scale_ + 0.09 : kHip) {
  if (!person.mesh_file.empty()) {
    parts_.push_back(ofHeight(readMeshFile(person.mesh_file, materials), person.height_m));
    rigid_ = true;
    return;
  }
  parts_.push_back(torso(person, materials));
  for (int side = 0; side < 2; ++side) {
    parts_.push_back(thigh(person, materials));
    parts_.push_back(shank(person, materials));
    parts_.push_back(upperArm(person, materials));
    parts_.push_back(foreArm(person, materials));
  }
  for (auto& part : parts_)
    for (auto& triangle : part.triangles)
      for (auto& corner : triangle.position) corner *= static_cast<float>(scale_);
}

std::vector<Pose3> PersonModel::pose(const PersonState& state) const {
  if (rigid_) return {Pose3::Identity()};
  const double swing = state.walks ? 0.42 * std::sin(state.phase) : 0.05;
  const double bob = state.walks ? -0.018 * (1 - std::cos(2 * state.phase)) : 0;
  std::vector<Pose3> out{joint({0, 0, hip_m_ + bob}, sits_ ? -0.12 : 0.03)};
  for (const double side : {-1.0, 1.0}) {
    const double leg = sits_ ? -1.5 : -side * swing;
    // The knee bends while its leg swings forward.
    const double knee = sits_         ? 1.45
                        : state.walks ? 0.12 + 0.5 * std::max(0.0, side * std::cos(state.phase))
                                      : 0.04;
    const Pose3 hip = joint({0, side * 0.095, hip_m_ + bob - 0.03}, leg);
    out.push_back(hip);
    out.push_back(hip * joint({0, 0, -kThigh}, knee));
    const Pose3 shoulder =
        out.front() * joint({-0.01, side * 0.225, kShoulder - 0.02}, sits_ ? -0.5 : side * 0.8 * swing);
    out.push_back(shoulder);
    out.push_back(shoulder * joint({0, 0, -kUpperArm}, sits_ ? -1.0 : -0.25));
  }
  for (auto& pose : out) pose.translation() *= scale_;
  return out;
}

PersonWalk::PersonWalk(const Person& person) : person_(person) {
  lengths_.push_back(0);
  for (std::size_t i = 1; i < person.path_m.size(); ++i)
    lengths_.push_back(lengths_.back() + (person.path_m[i] - person.path_m[i - 1]).norm());
}

PersonState PersonWalk::at(double seconds) const {
  constexpr double kTurn_s = 1.5, kStride_m = 1.3, kCorner_m = 0.35;
  PersonState out;
  const double total = lengths_.back();
  if (total < 1e-6) {
    out.pose = {person_.path_m.front().x(), person_.path_m.front().y(), person_.yaw_rad};
    return out;
  }
  const auto point = [&](double s) -> Eigen::Vector2d {
    s = std::clamp(s, 0.0, total);
    std::size_t i = 1;
    while (i + 1 < lengths_.size() && lengths_[i] < s) ++i;
    const double part = (s - lengths_[i - 1]) / std::max(1e-9, lengths_[i] - lengths_[i - 1]);
    return person_.path_m[i - 1] + part * (person_.path_m[i] - person_.path_m[i - 1]);
  };
  // Direction over a stretch around the place, so that corners are rounded.
  const auto heading = [&](double s) {
    const Eigen::Vector2d d = point(s + kCorner_m) - point(s - kCorner_m);
    return std::atan2(d.y(), d.x());
  };
  const double leg = total / person_.speed_m_s, lap = 2 * (leg + kTurn_s);
  double t = std::fmod(std::max(0.0, seconds - person_.start_s), lap);
  const bool back = t >= leg + kTurn_s;
  if (back) t -= leg + kTurn_s;
  out.walks = t < leg && seconds > person_.start_s;
  const double along = std::min(t, leg) * person_.speed_m_s, s = back ? total - along : along;
  const Eigen::Vector2d at = (point(s - kCorner_m / 2) + point(s + kCorner_m / 2)) / 2;
  const double turned = t < leg ? 0 : std::numbers::pi * (t - leg) / kTurn_s;
  out.pose = {at.x(), at.y(), wrapAngle(heading(s) + (back ? std::numbers::pi : 0) + turned)};
  out.phase = 2 * std::numbers::pi * along / kStride_m;
  return out;
}

}  // namespace roomgraph
