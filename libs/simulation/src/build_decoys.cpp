// SPDX-License-Identifier: BSD-3-Clause
// Meshes of things that are mistaken for others: visitor chair, stool, bench, round table, printer, coat
// stand.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "furniture_builders.h"
#include "roomgraph/core/random.h"

namespace roomgraph {
namespace {

using V = Eigen::Vector3d;
const Material kSteel{"metal", {0.55, 0.56, 0.58}, 0.5, 0};

Random shapeRandom(int shape) {
  return Random(0xdec0, 0, static_cast<std::uint64_t>(shape));
}

}  // namespace

void buildVisitorChair(const BuildRequest& r) {
  Random random = shapeRandom(r.shape);
  const double seat = random.uniform(0.42, 0.47), y = r.w / 2 - 0.03, x = r.d / 2 - 0.04;
  r.mesh.use(kSteel);
  for (const double side : {-1.0, 1.0}) {
    r.mesh.rod({x, side * y, 0}, {x, side * y, seat + 0.02}, 0.014, 0.014);
    r.mesh.capsule({-x, side * y, 0.014}, {-x + 0.06, side * y, seat}, 0.014, 0.014);
    r.mesh.capsule({-x + 0.06, side * y, seat}, {-x, side * y, r.h - 0.02}, 0.014, 0.014);
    r.mesh.rod({x, side * y, seat - 0.02}, {-x + 0.06, side * y, seat - 0.02}, 0.012, 0.012);
  }
  if (random.chance(0.5)) {
    r.mesh.use({"plain", {0.1, 0.1, 0.11}, 1, 0});
    for (const double side : {-1.0, 1.0}) {
      r.mesh.rod({0.05, side * y, seat}, {0.05, side * y, seat + 0.19}, 0.012, 0.012);
      r.mesh.roundedBox({0, side * y, seat + 0.2}, {r.d * 0.6, 0.05, 0.03}, 0.012);
    }
  }
  const double low = seat + random.uniform(0.06, 0.16);
  r.mesh.use({"fabric", r.color, 0.4, 0}).roundedBox({0.01, 0, seat}, {r.d - 0.08, r.w - 0.07, 0.06}, 0.028);
  r.mesh.roundedBox({-x + 0.03, 0, (low + r.h) / 2}, {0.045, r.w - 0.07, r.h - low}, 0.02);
}

void buildStool(const BuildRequest& r) {
  Random random = shapeRandom(r.shape);
  const double radius = std::min(r.w, r.d) / 2, top = random.uniform(0.03, 0.07);
  const bool padded = random.chance(0.5);
  r.mesh.use(padded ? Material{"leather", r.color, 0.4, 0} : Material{"wood", r.color, 0.6, 0});
  r.mesh.lathe({0, 0, r.h - top}, {{0, 0}, {radius * 0.97, 0}, {radius, top / 2}, {radius * 0.95, top}, {0, top}});
  if (random.chance(0.3)) {  // one column on a plate
    r.mesh.use(kSteel).rod({0, 0, 0.02}, {0, 0, r.h - top}, 0.03, 0.025);
    r.mesh.lathe({0, 0, 0}, {{0, 0}, {radius * 0.9, 0}, {radius * 0.85, 0.02}, {0, 0.025}});
    return;
  }
  r.mesh.use(padded ? kSteel : Material{"wood", toned(r.color, 0.85), 0.6, 0});
  for (int i = 0; i < 4; ++i) {
    const double angle = std::numbers::pi * (0.25 + 0.5 * i);
    const V out(std::cos(angle), std::sin(angle), 0);
    r.mesh.rod(0.92 * radius * out, 0.65 * radius * out + V(0, 0, r.h - top), 0.015, 0.018);
  }
}

void buildBench(const BuildRequest& r) {
  Random random = shapeRandom(r.shape);
  const bool back = r.h > 0.6;
  const double seat = back ? 0.45 : r.h, thick = random.uniform(0.03, 0.06);
  r.mesh.use({"wood", r.color, 0.8, 0});
  if (random.chance(0.5))
    for (const double x : {-0.3, 0.0, 0.3}) r.mesh.box({x * r.d, 0, seat - thick / 2}, {0.27 * r.d, r.w, thick});
  else
    r.mesh.use({"leather", r.color, 0.5, 0}).roundedBox({0, 0, seat - thick}, {r.d, r.w, 2 * thick}, thick * 0.8);
  r.mesh.use(kSteel);
  for (const double side : {-1.0, 1.0}) {
    const double y = side * (r.w / 2 - 0.12);
    for (const double x : {-0.38, 0.38}) r.mesh.box({x * r.d, y, (seat - thick) / 2}, {0.04, 0.04, seat - thick});
    r.mesh.box({0, y, seat - thick - 0.02}, {0.8 * r.d, 0.04, 0.03});
    if (back) r.mesh.box({-0.46 * r.d, y, (seat + r.h) / 2}, {0.03, 0.04, r.h - seat});
  }
  if (back)
    for (const double z : {0.6, 0.9})
      r.mesh.use({"wood", r.color, 0.8, 1}).box({-0.45 * r.d, 0, seat + z * (r.h - seat)}, {0.025, r.w, 0.09});
}

void buildRoundTable(const BuildRequest& r) {
  const double radius = r.w / 2;
  r.mesh.use({"wood", r.color, 1.0, 0});
  r.mesh.lathe({0, 0, r.h - 0.03}, {{0, 0}, {radius - 0.01, 0}, {radius, 0.015}, {radius - 0.01, 0.03}, {0, 0.03}});
  r.mesh.use({"metal", {0.25, 0.26, 0.28}, 0.5, 0}).rod({0, 0, 0.02}, {0, 0, r.h - 0.03}, 0.045, 0.035);
  r.mesh.lathe({0, 0, 0}, {{0, 0}, {0.5 * radius, 0}, {0.48 * radius, 0.02}, {0.06, 0.04}, {0, 0.04}});
}

void buildPrinter(const BuildRequest& r) {
  const double body = 0.86 * r.h;
  r.mesh.use({"paint", r.color, 1, 0}).roundedBox({0, 0, body / 2}, {r.d - 0.04, r.w, body}, 0.02);
  r.mesh.roundedBox({-0.12 * r.d, 0, (body + r.h) / 2}, {0.6 * r.d, 0.9 * r.w, r.h - body}, 0.012);
  // Slot, paper and control panel at the front, the cassette below.
  r.mesh.use({"plain", {0.08, 0.08, 0.09}, 1, 0}).box({0.3 * r.d, 0, body - 0.02}, {0.3 * r.d, 0.7 * r.w, 0.05});
  r.mesh.box({r.d / 2 - 0.018, 0, 0.22 * body}, {0.02, 0.82 * r.w, 0.01});
  r.mesh.use({"plain", {0.95, 0.95, 0.93}, 1, 0}).box({0.3 * r.d, 0, body + 0.008}, {0.24 * r.d, 0.48 * r.w, 0.008});
  r.mesh.use({"screen", {0.2, 0.4, 0.6}, 1, r.variant % 6})
      .box({r.d / 2 - 0.012, 0.3 * r.w, 0.75 * body}, {0.02, 0.22 * r.w, 0.06});
  r.mesh.use({"paint", toned(r.color, 0.8), 1, 0}).box({r.d / 2 - 0.01, 0, 0.12 * body}, {0.02, 0.8 * r.w, 0.14 * body});
}

void buildCoatStand(const BuildRequest& r) {
  Random random(0xc0a7, static_cast<std::uint64_t>(r.shape), static_cast<std::uint64_t>(r.variant));
  const double radius = std::min(r.w, r.d) / 2;
  r.mesh.use({"wood", r.color, 0.6, 0}).rod({0, 0, 0.03}, {0, 0, r.h}, 0.022, 0.016);
  const int arms = 4;
  for (int i = 0; i < arms; ++i) {
    const double angle = 2 * std::numbers::pi * i / arms;
    const V out(std::cos(angle), std::sin(angle), 0);
    r.mesh.use({"wood", r.color, 0.6, 0});
    r.mesh.capsule(0.03 * out + V(0, 0, 0.14), (radius - 0.02) * out + V(0, 0, 0.02), 0.018, 0.016);
    r.mesh.capsule(V(0, 0, r.h - 0.16), 0.55 * radius * out + V(0, 0, r.h - 0.06), 0.012, 0.012);
    if (!random.chance(0.7)) continue;
    const Rgb cloth{random.uniform(0.05, 0.6), random.uniform(0.05, 0.5), random.uniform(0.05, 0.5)};
    const double length = random.uniform(0.55, 1.0), z = r.h - 0.2;
    r.mesh.use({"fabric", cloth, 0.5, i});
    r.mesh.capsule(0.45 * radius * out + V(0, 0, z), 0.5 * radius * out + V(0, 0, z - 0.25), 0.07, 0.11);
    r.mesh.capsule(0.5 * radius * out + V(0, 0, z - 0.25), 0.55 * radius * out + V(0, 0, z - length), 0.11, 0.13);
  }
}

}  // namespace roomgraph
