// SPDX-License-Identifier: BSD-3-Clause
// Meshes of plant, monitor, cardboard box, bin and whiteboard.
#include <cmath>
#include <numbers>

#include "furniture_builders.h"
#include "roomgraph/core/random.h"

namespace roomgraph {
namespace {

/// A long leaf that rises and bends down, of three flat pieces, both sides visible.
void leafBlade(MeshBuilder& mesh, const Eigen::Vector3d& root, double heading, double rise, double length,
               double width) {
  const Eigen::Vector3d out(std::cos(heading), std::sin(heading), 0), side(-out.y(), out.x(), 0);
  Eigen::Vector3d from = root;
  double angle = rise;
  const double widths[4] = {0.3, 1.0, 0.8, 0.05};
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector3d to =
        from + length / 3 * (std::cos(angle) * out + Eigen::Vector3d(0, 0, std::sin(angle)));
    const Eigen::Vector3d a = width / 2 * widths[i] * side, b = width / 2 * widths[i + 1] * side;
    mesh.quad({from - a, from + a, to + b, to - b});
    mesh.quad({from + a, from - a, to - b, to + b});
    from = to;
    angle -= 0.55;
  }
}

}  // namespace

void buildPlant(const BuildRequest& r) {
  Random random(0x91a7, 0, static_cast<std::uint64_t>(r.variant));
  const double pot = 0.24 * r.h, radius = 0.27 * r.w;
  r.mesh.use({"paint", {0.62, 0.33, 0.22}, 1, 0});
  r.mesh.lathe({0, 0, 0}, {{0, 0},
                           {radius * 0.75, 0},
                           {radius, pot},
                           {radius * 0.9, pot},
                           {radius * 0.88, pot * 0.9},
                           {0, pot * 0.9}});
  r.mesh.use({"wood", {0.3, 0.22, 0.14}, 0.4, 0}).rod({0, 0, pot * 0.8}, {0, 0, r.h * 0.62}, 0.02, 0.012);
  for (int i = 0; i < 46; ++i) {
    const double level = random.uniform(0.3, 0.72);
    const int shade = i % 3;
    r.mesh.use({"leaf", toned(r.color, 0.8 + 0.22 * shade), 0.4, 0});
    leafBlade(r.mesh, {0, 0, level * r.h}, random.uniform(0, 2 * std::numbers::pi), random.uniform(0.4, 1.3),
              random.uniform(0.3, 0.46) * r.h * 0.9, random.uniform(0.05, 0.1));
  }
}

void buildMonitor(const BuildRequest& r) {
  r.mesh.use({"plain", r.color, 1, 0});
  r.mesh.roundedBox({-0.02, 0, 0.01}, {0.2, 0.26, 0.02}, 0.009);
  r.mesh.box({-0.05, 0, r.h * 0.35}, {0.03, 0.06, r.h * 0.6});
  const double low = r.h * 0.26, high = r.h - low;
  r.mesh.roundedBox({0, 0, low + high / 2}, {0.045, r.w, high}, 0.015);
  const double y = r.w / 2 - 0.014, x = 0.034;
  r.mesh.use({"screen", {0.2, 0.35, 0.55}, 1, r.variant % 6});
  r.mesh.quad({Eigen::Vector3d(x, -y, low + 0.014), Eigen::Vector3d(x, y, low + 0.014),
               Eigen::Vector3d(x, y, r.h - 0.014), Eigen::Vector3d(x, -y, r.h - 0.014)},
              true);
}

void buildCardboardBox(const BuildRequest& r) {
  r.mesh.use({"cardboard", r.color, std::max(r.w, 0.3), r.variant % 4}).box({0, 0, r.h / 2}, {r.d, r.w, r.h});
}

void buildBin(const BuildRequest& r) {
  r.mesh.use({"paint", r.color, 1, 0});
  const double radius = r.w / 2;
  r.mesh.lathe(
      {0, 0, 0},
      {{0, 0}, {radius * 0.8, 0}, {radius, r.h}, {radius * 0.94, r.h}, {radius * 0.78, 0.03}, {0, 0.03}});
}

void buildWhiteboard(const BuildRequest& r) {
  r.mesh.use({"metal", {0.6, 0.6, 0.62}, 0.5, 0}).box({-0.01, 0, r.h / 2}, {r.d - 0.02, r.w, r.h});
  const double y = r.w / 2 - 0.03, x = r.d / 2 - 0.003;
  r.mesh.use({"poster", {0.94, 0.95, 0.95}, 1, 900 + r.variant % 8});
  r.mesh.quad({Eigen::Vector3d(x, -y, 0.03), Eigen::Vector3d(x, y, 0.03), Eigen::Vector3d(x, y, r.h - 0.03),
               Eigen::Vector3d(x, -y, r.h - 0.03)},
              true);
  r.mesh.use({"metal", {0.5, 0.5, 0.52}, 0.5, 0}).box({r.d / 2 - 0.002, 0, 0.015}, {0.004, r.w * 0.6, 0.02});
}

}  // namespace roomgraph
