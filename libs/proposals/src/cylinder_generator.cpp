// SPDX-License-Identifier: BSD-3-Clause
// Cylinder hypotheses from depth points, the leg of the chair, or nominal size.
#include "cylinder_generator.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "leg_line.h"
#include "roomgraph/core/order_statistics.h"
#include "roomgraph/proposals/shape_fit.h"

namespace roomgraph {

IMPLEMENTS_MRPT_OBJECT(CylinderGenerator, ShapeGenerator, roomgraph)

namespace {

// Share of the radius between the axis and the point that the box's bottom side touches: below 1, as chair
// feet rarely point straight at the camera.
constexpr double kRim = 0.9;
constexpr double kNearest = 0.03, kFarthest = 0.97;  // quantiles taken for the ends of noisy points
constexpr double kSeat = 0.5;                        // share of the height up to which a seat may reach
constexpr double kFlat = 0.5;                        // share of the radius: a back rest is thinner
// Initial guesses from the leg's line that are fitted: their number, distance, and least IoU with the box.
constexpr int kLegStarts = 2;
constexpr double kLegSpacing_m = 0.15, kLegIou = 0.3;

PlacedShape placeAt(double bearing, double range, const BoxEvidence& e, const char* source) {
  PlacedShape placed = usualShape(e);
  placed.x = range * std::cos(bearing);
  placed.y = range * std::sin(bearing);
  placed.source = source;
  return placed;
}

// Bearing of the box's middle; when a side is cut, of the points' middle.
double bearingOfObject(const BoxEvidence& e) {
  if ((!e.cut.left && !e.cut.right) || e.mask.points.empty()) return bearingOf(e);
  std::vector<double> bearings;
  for (const auto& p : e.mask.points) bearings.push_back(std::atan2(p.in_ground.y(), p.in_ground.x()));
  return (quantile(bearings, kNearest) + quantile(bearings, kFarthest)) / 2;
}

// Ends of the depth points along a direction, without the farthest of either, m.
struct Reach {
  double near, far;
};
Reach reachOfPoints(const BoxEvidence& e, double bearing) {
  const Eigen::Vector2d ahead(std::cos(bearing), std::sin(bearing));
  std::vector<double> along;
  for (const auto& p : e.mask.points) along.push_back(ahead.dot(p.in_ground.head<2>()));
  return {quantile(along, kNearest), quantile(along, kFarthest)};
}

// Whether all that shows is a back rest above something nearer, a table: flat, and higher than the seat.
// Which side of it the seat is on cannot be seen.
bool isOnlyABackRest(const BoxEvidence& e) {
  if (!e.hidden.bottom || !e.model->rests_on_ground || e.mask.points.empty()) return false;
  std::vector<double> heights;
  for (const auto& p : e.mask.points) heights.push_back(p.in_ground.z());
  const Reach reach = reachOfPoints(e, bearingOfObject(e));
  return reach.far - reach.near < kFlat * e.model->nominal().radius() &&
         quantile(heights, kNearest) > kSeat * e.model->height_m;
}

// A back rest is narrower than the chair: the box's sides are its own.
BoxEvidence withHiddenSides(BoxEvidence e) {
  e.hidden.left = e.hidden.right = e.cut.left = e.cut.right = true;
  return e;
}

// With the seat behind the back rest and, as likely, before it. Each is as sure of its place along the view
// as one of two is that may be the other: half of the square of their distance.
std::vector<PlacedShape> guessesFromBackRest(const BoxEvidence& e) {
  const double bearing = bearingOfObject(e);
  const Reach reach = reachOfPoints(e, bearing);
  const double rim = kRim * e.model->nominal().radius();
  PlacedShape behind = placeAt(bearing, reach.near + rim, e, "back rest, seat behind it"),
              before = placeAt(bearing, reach.far - rim, e, "back rest, seat before it");
  before.behind_its_points = false;
  behind.open_along_m = before.open_along_m =
      std::abs(reach.near - reach.far + 2 * rim) / std::numbers::sqrt2;
  return {behind, before};
}

// Range of the axis from the points: the middle between nearest and farthest only when the whole depth of the
// object is seen; of a closed surface only the front is, a radius nearer than the axis.
double rangeFromPoints(const BoxEvidence& e, const Reach& reach) {
  const double rim = kRim * e.model->nominal().radius();
  const double front = reach.near + rim, rear = reach.far - rim;
  return rear > front ? (front + rear) / 2 : front;
}

// Where the ray through a pixel meets the ground, ground frame.
std::optional<Eigen::Vector2d> onGround(double u, double v, const BoxEvidence& e) {
  const auto point = intersect(e.camera.ray(u, v), e.ground);
  if (!point || point->norm() > kFarthestGround_m) return std::nullopt;
  return Eigen::Vector2d((e.camera_from_ground.inverse() * *point).head<2>());
}

// The paper's method: the leg's line, extended to the bottom side of the box, meets the ground there at the
// near rim. Without a clear leg each of several steep segments gives a column, and points at several heights
// of it are taken for the foot of the axis.
std::vector<PlacedShape> guessesFromLeg(const BoxEvidence& e) {
  constexpr int kSteps = 4;
  constexpr double kStep = 0.04;  // of the box's height
  std::vector<PlacedShape> out;
  if (e.cut.bottom || !e.model->rests_on_ground) return out;
  const LegLine leg = findLeg(e.segments, e.box);
  const auto place = [&](double u, double v, double beyond, const char* source) {
    if (const auto p = onGround(u, v, e)) {
      out.push_back(placeAt(std::atan2(p->y(), p->x()), p->norm() + beyond, e, source));
      if (leg.column) out.back().leg_column = leg.column;
    }
  };
  if (leg.column) {
    place(*leg.column, e.box.v_max, kRim * e.model->nominal().radius(), "leg line");
  } else {
    for (const double u : leg.votes)
      for (int k = 0; k < kSteps; ++k) place(u, e.box.v_max - k * kStep * e.box.height(), 0, "leg votes");
  }
  for (PlacedShape& placed : out) judge(placed, e);
  return keepBest(out, {kLegSpacing_m, kAnyYaw_rad}, {kLegStarts, kLegIou, nullptr});
}

std::vector<PlacedShape> cylinderGuesses(const BoxEvidence& e) {
  std::vector<PlacedShape> out;
  const double bearing = bearingOfObject(e), radius = e.model->nominal().radius();
  if (!e.mask.points.empty())
    out.push_back(placeAt(bearing, rangeFromPoints(e, reachOfPoints(e, bearing)), e, "depth"));
  if (const auto contact = contactPoint(e); contact && e.model->rests_on_ground)
    out.push_back(placeAt(bearing, contact->norm() + kRim * radius, e, "contact"));
  // Without depth, or with a side cut, the leg is more accurate than the box's middle.
  if (e.mask.points.empty() || e.cut.left || e.cut.right)
    for (const PlacedShape& placed : guessesFromLeg(e)) out.push_back(placed);
  // Without depth and visible bottom: at the range where the usual size is as wide as the box.
  if (out.empty() && !e.cut.left && !e.cut.right && halfAngleOf(e) > kLeastHalfAngle_rad)
    out.push_back(placeAt(bearing, radius / std::sin(halfAngleOf(e)), e, "size"));
  return out;
}

}  // namespace

std::vector<PlacedShape> CylinderGenerator::generate(const BoxEvidence& evidence,
                                                     const GeneratorLimits& limits) const {
  if (!heightKnown(evidence)) return {};
  std::vector<PlacedShape> fitted;
  if (isOnlyABackRest(evidence)) {
    const BoxEvidence e = withHiddenSides(evidence);
    for (const PlacedShape& guess : guessesFromBackRest(evidence)) fitted.push_back(fitShape(guess, e));
  } else {
    for (const PlacedShape& guess : cylinderGuesses(evidence)) fitted.push_back(fitShape(guess, evidence));
  }
  return keepBest(fitted, {.angle_rad = kAnyYaw_rad}, limits);
}

}  // namespace roomgraph
