// SPDX-License-Identifier: BSD-3-Clause
// Cells of a footprint in two grids.
#include "change_evidence.h"

namespace roomgraph {
namespace {

constexpr double kAround_m = 0.15;  // an object is seen by what is around it, too
constexpr double kLeastMet_m2 = 0.004;
constexpr double kSurprise = 0.1;  // chance that cells say the opposite

struct Area {
  double occupied_m2 = 0, known_m2 = 0, all_m2 = 0;
};

Area areaOf(const CSemanticMap& map, const Polygon2& place, double margin) {
  Area out;
  if (!map.occupancy) return out;
  const double cell = static_cast<double>(map.occupancy->getResolution());
  forCellsNear(*map.occupancy, place, margin, [&](int x, int y) {
    const float p_free = map.occupancy->getCell(x, y);
    const bool occupied = isOccupiedCell(p_free);
    out.occupied_m2 += occupied ? cell * cell : 0;
    out.known_m2 += occupied || isFreeCell(p_free) ? cell * cell : 0;
  });
  return out;
}

// Of the whole place, inside the grid or not.
double areaAround(const Polygon2& place) {
  double area = 0, around = 0;
  for (std::size_t i = 0, j = place.size() - 1; i < place.size(); j = i++) {
    area += (place[j].x() * place[i].y() - place[i].x() * place[j].y()) / 2;
    around += (place[i] - place[j]).norm();
  }
  return std::abs(area) + around * kAround_m + 3.14159 * kAround_m * kAround_m;
}

}  // namespace

double PlaceEvidence::probabilityOfChange(double beforehand, double found) const {
  double changed = beforehand, unchanged = (1 - beforehand) * (1 - found * seen);
  if (met_by_lidar) {
    changed *= kSurprise + (1 - 2 * kSurprise) * (1 - still_there);
    unchanged *= kSurprise + (1 - 2 * kSurprise) * still_there;
  }
  return changed / (changed + unchanged);
}

PlaceEvidence placeEvidence(const Landmark& landmark, const CSemanticMap& own, const CSemanticMap& other) {
  const Polygon2 place = footprintOf(landmark);
  PlaceEvidence out;
  out.seen = std::min(1.0, areaOf(other, place, kAround_m).known_m2 / areaAround(place));
  // Doors are occupied when closed and free when open.
  if (landmark.shape.kind == ShapeKind::kPlanar) return out;
  const Area mine = areaOf(own, place, 0), theirs = areaOf(other, place, 0);
  const bool asked = theirs.known_m2 >= 0.5 * mine.known_m2;
  out.met_by_lidar = asked && mine.occupied_m2 >= kLeastMet_m2;
  if (out.met_by_lidar) out.still_there = std::min(1.0, theirs.occupied_m2 / mine.occupied_m2);
  return out;
}

}  // namespace roomgraph
