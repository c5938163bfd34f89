// SPDX-License-Identifier: BSD-3-Clause
// Surfaces, posters and light of a random flat, from rich patterns to bare paint.
#include <algorithm>

#include "flat_draft.h"

namespace roomgraph {
namespace {

using Color = std::array<double, 3>;

const std::vector<Color> kWallColors{{0.93, 0.92, 0.89}, {0.86, 0.84, 0.78}, {0.80, 0.84, 0.86}, {0.88, 0.82, 0.72},
                                     {0.78, 0.84, 0.77}, {0.84, 0.76, 0.74}, {0.70, 0.74, 0.80}};

Color varied(const Color& color, Random& random) {
  const double gain = random.uniform(0.9, 1.05);
  Color out;
  for (std::size_t i = 0; i < 3; ++i) out[i] = std::clamp(color[i] * gain, 0.0, 1.0);
  return out;
}

Material wallSurface(double richness, Random& random) {
  const Color color = varied(pick(random, kWallColors), random);
  if (richness < 0.3) return {random.chance(0.5) ? "plain" : "paint", color, 2.0, 0};
  if (richness > 0.75 && random.chance(0.35)) return {"fabric", color, inSteps(random.uniform(0.8, 1.6), 0.1), 0};
  return {richness > 0.6 ? "plaster" : "paint", color, inSteps(random.uniform(1.2, 2.4), 0.1), 0};
}

Material floorSurface(double richness, Random& random) {
  const double u = random.uniform();
  if (richness < 0.25 && u < 0.6) return {"paint", varied({0.62, 0.61, 0.58}, random), 2.0, 0};
  if (u < 0.35) return {"parquet", varied({0.58, 0.42, 0.26}, random), inSteps(random.uniform(0.9, 1.6), 0.1), 0};
  if (u < 0.55) return {"tiles", varied({0.72, 0.7, 0.66}, random), inSteps(random.uniform(0.5, 0.9), 0.1), 0};
  if (u < 0.7) return {"wood", varied({0.5, 0.36, 0.22}, random), 1.2, 0};
  return {"carpet", varied(pick<Color>(random, {{0.42, 0.44, 0.47}, {0.35, 0.4, 0.5}, {0.5, 0.42, 0.36}}), random),
          inSteps(random.uniform(1.0, 1.6), 0.1), 0};
}

/// Is the stretch of wall free of doorways, of this room or a neighbour's?
bool wallIsFree(const FlatDraft& draft, const Room& room, const Poster& poster) {
  const Pose2 frame = planarPart(wallFrame(room, poster.side, poster.at_m));
  PlanBox area(frame * Eigen::Vector2d(0.05, -poster.width_m / 2 - 0.1));
  area.extend(frame * Eigen::Vector2d(-draft.world.wall_thickness_m, poster.width_m / 2 + 0.1));
  for (const auto& other : draft.world.rooms) {
    for (const auto& doorway : other.doorways)
      if (area.intersects(doorwayHole(draft.world, other, doorway))) return false;
  }
  for (const auto& other : room.posters)
    if (other.side == poster.side &&
        std::abs(other.at_m - poster.at_m) < (other.width_m + poster.width_m) / 2 + 0.1)
      return false;
  return true;
}

void addPosters(const FlatDraft& draft, Room& room, double richness, Random& random) {
  const int wanted = richness < 0.3 ? 0 : drawInt(random, 0, static_cast<int>(2 + 8 * (richness - 0.3)));
  for (int i = 0; i < wanted; ++i) {
    Poster poster;
    poster.side = static_cast<Side>(drawInt(random, 0, 3));
    poster.width_m = inSteps(random.uniform(0.3, 1.1));
    poster.height_m = inSteps(random.uniform(0.4, 1.0));
    poster.z_m = inSteps(random.uniform(1.35, 1.7));
    poster.variant = drawInt(random, 0, 9999);
    const int along = poster.side == Side::kNorth || poster.side == Side::kSouth ? 0 : 1;
    const double half = poster.width_m / 2 + 0.05;
    poster.at_m = inSteps(random.uniform(room.min_m[along] + half, room.max_m[along] - half));
    if (wallIsFree(draft, room, poster)) room.posters.push_back(poster);
  }
}

}  // namespace

void decorateFlat(FlatDraft& draft, Random& random) {
  draft.world.light = drawSkewed(random, 0.4, 1.08, 0.7);
  for (auto& room : draft.world.rooms) {
    const double richness = random.uniform();
    draft.richness.push_back(richness);
    room.wall = wallSurface(richness, random);
    room.floor = floorSurface(richness, random);
    addPosters(draft, room, richness, random);
  }
}

}  // namespace roomgraph
