// SPDX-License-Identifier: BSD-3-Clause
// Greedy label placement by covered area over candidate positions.
#include "labels.h"

#include <Eigen/Core>
#include <array>
#include <limits>

namespace roomgraph {
namespace {

constexpr double kGap_px = 5;                              ///< between a label and what it keeps off
constexpr std::array<double, 5> kRings{0, 6, 14, 26, 42};  ///< px, farther and farther from the object

/// Directions from the object to the label's centre, the preferred one first.
const std::array<Eigen::Vector2d, 8> kDirections{
    Eigen::Vector2d(0, 1), Eigen::Vector2d(0, -1), Eigen::Vector2d(1, 0),  Eigen::Vector2d(-1, 0),
    Eigen::Vector2d(1, 1), Eigen::Vector2d(-1, 1), Eigen::Vector2d(1, -1), Eigen::Vector2d(-1, -1)};

Box2 boxAt(const Label& label, const Eigen::Vector2d& direction, double distance) {
  const Eigen::Vector2d half(label.object.width() / 2 + label.width / 2 + kGap_px + distance,
                             label.object.height() / 2 + label.height / 2 + kGap_px + distance);
  const Eigen::Vector2d center = label.object.center() + direction.cwiseProduct(half);
  return {center.x() - label.width / 2, center.y() - label.height / 2, center.x() + label.width / 2,
          center.y() + label.height / 2};
}

Box2 grown(const Box2& box, double by) {
  return {box.u_min - by, box.v_min - by, box.u_max + by, box.v_max + by};
}

/// Areas covered, in parts of the label's own area: other labels hurt most.
double cost(const std::vector<Label>& labels, std::size_t index, const Box2& place, const Box2& area) {
  const Box2 own = grown(place, kGap_px / 2);
  double sum = 20 * (own.area() - intersection(own, area).area());
  for (std::size_t i = 0; i < labels.size(); ++i) {
    if (i < index) sum += 10 * intersection(own, grown(labels[i].place, kGap_px / 2)).area();
    sum += (i == index ? 2 : 4) * intersection(own, labels[i].object).area();
  }
  return sum / own.area();
}

}  // namespace

void placeLabels(std::vector<Label>& labels, const Box2& area) {
  for (std::size_t i = 0; i < labels.size(); ++i) {
    double best = std::numeric_limits<double>::infinity();
    for (std::size_t ring = 0; ring < kRings.size(); ++ring) {
      for (std::size_t direction = 0; direction < kDirections.size(); ++direction) {
        const Box2 place = boxAt(labels[i], kDirections[direction], kRings[ring]);
        const double total = cost(labels, i, place, area) + 0.12 * static_cast<double>(ring) +
                             0.01 * static_cast<double>(direction);
        if (total >= best) continue;
        best = total;
        labels[i].place = place;
      }
    }
  }
}

}  // namespace roomgraph
