// SPDX-License-Identifier: BSD-3-Clause
// Meshes of swivel chair, sofa (also as armchair) and wooden chair.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "furniture_builders.h"
#include "roomgraph/core/random.h"

namespace roomgraph {
namespace {

/// Proportions of a swivel chair before it is fitted to its size, m.
struct SwivelShape {
  double seat = 0.48, cushion_d = 0.5, cushion_w = 0.5;
  double back_middle = 0.33, back_high = 0.56, side_high = 0.5;  ///< over the seat; middle and side panels
  double arm_high = 0.19, base = 0.29;
  int legs = 5;
  bool arms = true;
};

SwivelShape swivelShape(int shape, int variant) {
  SwivelShape out;
  out.arms = variant % 3 != 2;
  if (shape == 0) return out;
  Random random(0x5ea7, 0, static_cast<std::uint64_t>(shape));
  out.seat = random.uniform(0.42, 0.52);
  out.cushion_d = random.uniform(0.44, 0.52);
  out.cushion_w = random.uniform(0.43, 0.52);
  out.back_high = random.uniform(0.34, 0.72);
  out.side_high = out.back_high * random.uniform(0.8, 1.0);
  out.back_middle = random.uniform(0.07, 0.12) + out.back_high / 2;
  out.arm_high = random.uniform(0.13, 0.21);
  out.base = random.uniform(0.26, 0.33);
  out.legs = random.chance(0.8) ? 5 : 4;
  out.arms = random.chance(0.55);
  return out;
}

/// Proportions of a sofa, m.
struct SofaShape {
  double arm = 0.2, back = 0.22, seat = 0.43, arm_high = 0.52;
};

SofaShape sofaShape(int shape, double height) {
  SofaShape out;
  if (shape == 0) return out;
  Random random(0x50fa, 0, static_cast<std::uint64_t>(shape));
  out.arm = random.uniform(0.07, 0.25);
  out.back = random.uniform(0.14, 0.27);
  out.seat = random.uniform(0.37, std::min(0.48, height - 0.22));
  out.arm_high = random.uniform(0.4, std::min(0.6, height - 0.12));
  return out;
}

constexpr Rgb kBlackPlastic{0.09, 0.09, 0.10}, kChrome{0.62, 0.63, 0.65};

void starBase(MeshBuilder& mesh, double radius, int legs) {
  mesh.use({"plain", kBlackPlastic, 1, 0});
  for (int i = 0; i < legs; ++i) {
    const double angle = 2 * std::numbers::pi * (i + 0.5) / legs;
    const Eigen::Vector3d out(std::cos(angle), std::sin(angle), 0);
    const Eigen::Vector3d tip = radius * out + Eigen::Vector3d(0, 0, 0.075);
    mesh.capsule(Eigen::Vector3d(0, 0, 0.105) + 0.03 * out, tip, 0.028, 0.018);
    const Eigen::Vector3d across(-out.y(), out.x(), 0);
    for (const double side : {-0.018, 0.018})
      mesh.rod(tip + side * across - Eigen::Vector3d(0, 0, 0.047),
               tip + 1.5 * side * across - Eigen::Vector3d(0, 0, 0.047), 0.028, 0.028);
  }
  mesh.rod({0, 0, 0.07}, {0, 0, 0.24}, 0.034, 0.03);
  mesh.use({"metal", kChrome, 0.5, 0}).rod({0, 0, 0.2}, {0, 0, 0.42}, 0.018, 0.018);
}

void armRests(MeshBuilder& mesh, double half_width, double seat, double high) {
  mesh.use({"plain", kBlackPlastic, 1, 0});
  for (const double side : {-1.0, 1.0}) {
    const double y = side * half_width;
    mesh.capsule({-0.02, side * 0.16, seat - 0.06}, {-0.02, y, seat - 0.04}, 0.018, 0.018);
    mesh.capsule({-0.02, y, seat - 0.04}, {-0.03, y, seat + high}, 0.02, 0.018);
    mesh.roundedBox({0.01, y, seat + (high + 0.02)}, {0.27, 0.07, 0.035}, 0.016);
  }
}

}  // namespace

Rgb toned(const Rgb& color, double gain) {
  Rgb out;
  for (std::size_t i = 0; i < 3; ++i) out[i] = std::clamp(color[i] * gain, 0.0, 1.0);
  return out;
}

void buildSwivelChair(const BuildRequest& r) {
  const SwivelShape shape = swivelShape(r.shape, r.variant);
  const double seat = shape.seat, half = 0.29;
  starBase(r.mesh, shape.base, shape.legs);
  r.mesh.use({"plain", kBlackPlastic, 1, 0}).box({0, 0, seat - 0.075}, {0.24, 0.2, 0.05});
  // Bar from below the seat up to the back.
  r.mesh.capsule({-0.1, 0, seat - 0.07}, {-0.255, 0, seat - 0.03}, 0.024, 0.024);
  r.mesh.capsule({-0.255, 0, seat - 0.03}, {-0.275, 0, seat + 0.3}, 0.024, 0.02);
  if (shape.arms) armRests(r.mesh, half, seat, shape.arm_high);
  r.mesh.use({"fabric", r.color, 0.4, 0}).roundedBox({0.02, 0, seat - 0.01}, {shape.cushion_d, shape.cushion_w, 0.09}, 0.042);
  // The back leans by 8 degrees and is a little hollow: three panels.
  for (const double side : {-1.0, 0.0, 1.0}) {
    Pose3 lean = Pose3::Identity();
    lean.translate(Eigen::Vector3d(-0.245 + 0.018 * std::abs(side), side * 0.14, seat + shape.back_middle));
    lean.rotate(Eigen::AngleAxisd(-0.14, Eigen::Vector3d::UnitY()));
    lean.rotate(Eigen::AngleAxisd(-0.22 * side, Eigen::Vector3d::UnitZ()));
    r.mesh.frame(lean).roundedBox(Eigen::Vector3d::Zero(),
                                  {0.065, side == 0 ? 0.24 : 0.2, side == 0 ? shape.back_high : shape.side_high}, 0.032);
  }
  r.mesh.frame(Pose3::Identity());
}

void buildSofa(const BuildRequest& r) {
  const SofaShape shape = sofaShape(r.shape, r.h);
  const double arm = shape.arm, back = shape.back, seat = shape.seat, inner = r.w - 2 * arm;
  const Material cloth{"fabric", r.color, 0.5, 0}, cushion{"fabric", toned(r.color, 1.08), 0.5, 0};
  r.mesh.use({"wood", {0.16, 0.11, 0.08}, 0.6, 0});
  for (const double x : {-1.0, 1.0})
    for (const double y : {-1.0, 1.0})
      r.mesh.rod({x * (r.d / 2 - 0.08), y * (r.w / 2 - 0.08), 0},
                 {x * (r.d / 2 - 0.08), y * (r.w / 2 - 0.08), 0.09}, 0.022, 0.03);
  r.mesh.use(cloth).roundedBox({0, 0, 0.19}, {r.d - 0.03, r.w - 0.04, 0.22}, 0.03);
  r.mesh.roundedBox({-r.d / 2 + back / 2, 0, (r.h - 0.04 + 0.1) / 2}, {back, r.w - 0.02, r.h - 0.14}, 0.07);
  for (const double side : {-1.0, 1.0})
    r.mesh.roundedBox({0.0, side * (r.w - arm) / 2, 0.1 + shape.arm_high / 2}, {r.d, arm, shape.arm_high}, 0.08);
  const int places = std::max(1, static_cast<int>(std::lround(inner / 0.65)));
  const double width = inner / places;
  for (int i = 0; i < places; ++i) {
    const double y = -inner / 2 + (i + 0.5) * width;
    r.mesh.use(cushion).roundedBox({back / 2 + 0.005, y, seat - 0.07},
                                   {r.d - back - 0.02, width - 0.012, 0.17}, 0.055);
    Pose3 lean = Pose3::Identity();
    lean.translate(Eigen::Vector3d(-r.d / 2 + back + 0.06, y, seat + (r.h - seat) / 2 + 0.0));
    lean.rotate(Eigen::AngleAxisd(-0.16, Eigen::Vector3d::UnitY()));
    r.mesh.frame(lean).roundedBox(Eigen::Vector3d::Zero(), {0.17, width - 0.02, r.h - seat - 0.03}, 0.075);
    r.mesh.frame(Pose3::Identity());
  }
}

void buildWoodenChair(const BuildRequest& r) {
  r.mesh.use({"wood", r.color, 0.6, 0});
  const double x = r.d / 2 - 0.03, y = r.w / 2 - 0.03, seat = 0.45;
  for (const double side : {-1.0, 1.0}) {
    r.mesh.box({x, side * y, seat / 2}, {0.035, 0.035, seat});
    r.mesh.box({-x, side * y, r.h / 2}, {0.035, 0.035, r.h});
    r.mesh.box({0, side * y, 0.2}, {2 * x, 0.02, 0.025});
  }
  r.mesh.roundedBox({0, 0, seat}, {r.d, r.w, 0.035}, 0.012);
  for (const double z : {0.62, 0.74, 0.86}) r.mesh.box({-x, 0, z * r.h / 0.92}, {0.02, 2 * y, 0.06});
}

}  // namespace roomgraph
