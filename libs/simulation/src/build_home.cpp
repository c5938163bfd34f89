// SPDX-License-Identifier: BSD-3-Clause
// Meshes of bed, table, cupboard and refrigerator.
#include "furniture_builders.h"

namespace roomgraph {

void buildBed(const BuildRequest& r) {
  constexpr double kBoard = 0.06, kLeg = 0.08;
  const double mattress = 0.55 * r.h, frame = 0.33 * r.h;
  // The headboard is the back.
  r.mesh.use({"wood", r.color, 1.0, 0}).box({-r.d / 2 + kBoard / 2, 0, r.h / 2}, {kBoard, r.w, r.h});
  r.mesh.box({kBoard / 2, 0, (frame + kLeg) / 2}, {r.d - kBoard, r.w, frame - kLeg});
  for (const double x : {-0.4, 0.45})
    for (const double y : {-0.45, 0.45}) r.mesh.box({x * r.d, y * r.w, kLeg / 2}, {kLeg, kLeg, kLeg});
  r.mesh.use({"fabric", {0.85, 0.84, 0.8}, 0.6, 0})
      .roundedBox({kBoard / 2, 0, (mattress + frame) / 2}, {r.d - 2 * kBoard, r.w - 0.04, mattress - frame}, 0.05);
  r.mesh.use({"fabric", {0.36, 0.45, 0.58}, 0.5, 1})
      .roundedBox({0.15 * r.d, 0, mattress + 0.02}, {0.62 * r.d, r.w - 0.02, 0.08}, 0.035);
  r.mesh.use({"fabric", {0.93, 0.92, 0.9}, 0.4, 2});
  for (const double side : {-1.0, 1.0})
    r.mesh.roundedBox({-0.36 * r.d, side * r.w / 4, mattress + 0.04}, {0.18 * r.d, 0.4 * r.w, 0.12}, 0.05);
}

void buildTable(const BuildRequest& r) {
  constexpr double kTop = 0.035, kLeg = 0.07, kApron = 0.08;
  r.mesh.use({"wood", r.color, 1.0, 0}).box({0, 0, r.h - kTop / 2}, {r.d, r.w, kTop});
  for (const double x : {-1.0, 1.0})
    for (const double y : {-1.0, 1.0})
      r.mesh.box({x * (r.d / 2 - kLeg), y * (r.w / 2 - kLeg), (r.h - kTop) / 2}, {kLeg, kLeg, r.h - kTop});
  for (const double side : {-1.0, 1.0}) {
    r.mesh.box({side * (r.d / 2 - kLeg), 0, r.h - kTop - kApron / 2}, {0.02, r.w - 3 * kLeg, kApron});
    r.mesh.box({0, side * (r.w / 2 - kLeg), r.h - kTop - kApron / 2}, {r.d - 3 * kLeg, 0.02, kApron});
  }
}

void buildCupboard(const BuildRequest& r) {
  constexpr double kDoor = 0.02, kGap = 0.012;
  r.mesh.use({"wood", r.color, 1.0, 0}).box({-kDoor, 0, r.h / 2}, {r.d - 2 * kDoor, r.w, r.h});
  for (const double side : {-1.0, 1.0}) {
    r.mesh.use({"wood", toned(r.color, 1.15), 1.0, 1})
        .box({r.d / 2 - 1.5 * kDoor, side * r.w / 4, r.h / 2}, {kDoor, r.w / 2 - kGap, r.h - 0.08});
    r.mesh.use({"metal", {0.3, 0.3, 0.32}, 0.5, 0})
        .box({r.d / 2 - kDoor / 2, side * 0.06, 0.55 * r.h}, {kDoor, 0.02, 0.14});
  }
}

void buildRefrigerator(const BuildRequest& r) {
  constexpr double kDoor = 0.05, kGrip = 0.03, kGap = 0.01;
  const double split = 0.62 * r.h, front = r.d / 2 - kGrip - kDoor / 2;
  r.mesh.use({"paint", r.color, 1, 0}).box({-(kDoor + kGrip) / 2, 0, r.h / 2}, {r.d - kDoor - kGrip, r.w, r.h});
  r.mesh.use({"paint", toned(r.color, 1.05), 1, 1}).box({front, 0, split / 2}, {kDoor, r.w, split - kGap});
  r.mesh.box({front, 0, (split + r.h) / 2}, {kDoor, r.w, r.h - split - kGap});
  r.mesh.use({"metal", {0.55, 0.56, 0.58}, 0.5, 0});
  for (const double z : {split - 0.2, split + 0.2})
    r.mesh.box({r.d / 2 - kGrip / 2, 0.42 * r.w, z}, {kGrip, 0.025, 0.28});
}

}  // namespace roomgraph
