// SPDX-License-Identifier: BSD-3-Clause
// Meshes of desk, shelf, cabinet and block.
#include <algorithm>
#include <cmath>

#include "furniture_builders.h"
#include "roomgraph/core/random.h"

namespace roomgraph {
namespace {

void books(MeshBuilder& mesh, Random& random, double x, double y_from, double y_to, double z, double room) {
  for (double y = y_from; y < y_to - 0.07;) {
    if (random.chance(0.12)) {
      y += random.uniform(0.05, 0.2);
      continue;
    }
    const double thick = random.uniform(0.02, 0.055),
                 high = std::min(room - 0.02, random.uniform(0.19, 0.29));
    const Rgb color{random.uniform(0.1, 0.85), random.uniform(0.1, 0.75), random.uniform(0.1, 0.75)};
    // Few distinct colours keep the number of draw calls low.
    const Rgb stepped{std::round(color[0] * 3) / 3, std::round(color[1] * 3) / 3,
                      std::round(color[2] * 2) / 2};
    mesh.use({"paint", stepped, 1, 0}).box({x, y + thick / 2, z + high / 2}, {0.19, thick - 0.002, high});
    y += thick;
  }
}

}  // namespace

void buildDesk(const BuildRequest& r) {
  r.mesh.use({"wood", r.color, 1.0, 0}).box({0, 0, r.h - 0.014}, {r.d, r.w, 0.028});
  r.mesh.use({"metal", {0.45, 0.46, 0.48}, 0.5, 0});
  for (const double side : {-1.0, 1.0}) {
    const double y = side * (r.w / 2 - 0.06);
    r.mesh.box({0, y, 0.02}, {r.d - 0.06, 0.06, 0.04});
    r.mesh.box({-0.08, y, r.h / 2}, {0.08, 0.045, r.h - 0.05});
    r.mesh.box({0, y, r.h - 0.05}, {r.d - 0.1, 0.04, 0.04});
  }
  r.mesh.use({"paint", {0.72, 0.72, 0.73}, 1, 0})
      .box({-r.d / 2 + 0.06, 0, r.h - 0.22}, {0.018, r.w - 0.2, 0.34});
  if (r.w > 1.1)
    for (int i = 0; i < 3; ++i) {
      const double z = 0.18 + 0.17 * i;
      r.mesh.use({"paint", {0.78, 0.78, 0.79}, 1, 0}).box({0.02, r.w / 2 - 0.3, z}, {r.d - 0.2, 0.38, 0.16});
      r.mesh.use({"metal", {0.3, 0.3, 0.32}, 0.5, 0})
          .box({r.d / 2 - 0.07, r.w / 2 - 0.3, z + 0.03}, {0.02, 0.12, 0.015});
    }
}

void buildShelf(const BuildRequest& r) {
  Random random(0x5e1f, 0, static_cast<std::uint64_t>(r.variant));
  const Material wood{"wood", r.color, 1.0, 0};
  r.mesh.use(wood);
  for (const double side : {-1.0, 1.0}) r.mesh.box({0, side * (r.w / 2 - 0.011), r.h / 2}, {r.d, 0.022, r.h});
  r.mesh.box({-r.d / 2 + 0.005, 0, r.h / 2}, {0.01, r.w - 0.04, r.h - 0.02});
  const int boards = std::max(2, static_cast<int>(std::lround(r.h / 0.36)));
  const double room = (r.h - 0.08) / boards;
  for (int i = 0; i <= boards; ++i) {
    const double z = 0.06 + i * room;
    r.mesh.use(wood).box({0, 0, std::min(z, r.h - 0.011)}, {r.d - 0.004, r.w - 0.044, 0.022});
    if (i < boards) books(r.mesh, random, 0.02, -r.w / 2 + 0.03, r.w / 2 - 0.03, z + 0.011, room - 0.02);
  }
}

void buildCabinet(const BuildRequest& r) {
  r.mesh.use({"paint", r.color, 1, 0}).box({-0.01, 0, r.h / 2}, {r.d - 0.02, r.w, r.h});
  const int drawers = std::max(2, static_cast<int>(std::lround(r.h / 0.33)));
  const double high = (r.h - 0.06) / drawers;
  for (int i = 0; i < drawers; ++i) {
    const double z = 0.04 + (i + 0.5) * high;
    r.mesh.use({"paint", toned(r.color, 1.06), 1, 0})
        .box({r.d / 2 - 0.02, 0, z}, {0.02, r.w - 0.03, high - 0.018});
    r.mesh.use({"metal", {0.25, 0.25, 0.27}, 0.5, 0})
        .box({r.d / 2 - 0.006, 0, z + 0.06}, {0.012, 0.14, 0.02});
  }
}

void buildBlock(const BuildRequest& r) {
  r.mesh.use({"paint", r.color, 2.0, 0}).box({0, 0, r.h / 2}, {r.d, r.w, r.h});
}

}  // namespace roomgraph
