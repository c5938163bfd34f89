// SPDX-License-Identifier: BSD-3-Clause
// Cuboid hypotheses from depth points, ground contact or nominal size.
#include "cuboid_generator.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "cuboid_corners.h"
#include "rectangle_fit.h"
#include "roomgraph/proposals/shape_fit.h"

namespace roomgraph {

IMPLEMENTS_MRPT_OBJECT(CuboidGenerator, ShapeGenerator, roomgraph)

namespace {

// Without depth there are hundreds of initial guesses, most of them nearly the same.
constexpr SamePlace kBlindStarts{0.15, 0.2};
constexpr double kMostOverUsual = 2;             // standard deviations by which an observed size may exceed the usual
constexpr double kSideways = 0.5;                // sine of the angle to the view from which an axis runs across it
constexpr std::size_t kFootprintPoints = 250;    // enough for two lines; more only cost time
constexpr int kContactYaws = 8;                  // samples over a full turn
constexpr double kLeastContactDistance_m = 0.1;  // nearer to the point below the camera the direction is undefined

// Where the unseen part of an axis is.
struct UnseenPart {
  double direction = 0;  // +1 or -1; 0: at both ends
  bool cut = false;      // beyond a side of the box: what is seen is only a part
};

// One axis of the model: the observed extent when it is about as long as usual; otherwise the usual size, extended from
// the visible side.
struct AxisFit {
  double center = 0, size = 0;
};

AxisFit fitAxis(double center, double observed, double usual, double sigma, const UnseenPart& unseen) {
  const double least = unseen.cut ? usual : usual - sigma;
  if (observed >= least) return {center, std::min(observed, usual + kMostOverUsual * sigma)};
  return {center + unseen.direction * (usual - observed) / 2, usual};
}

// The unseen part of an axis that runs sideways is beyond the side of the box that is cut, half of it beyond each when
// both are; else it is behind.
UnseenPart unseenPartOf(const Eigen::Vector2d& axis, const Eigen::Vector2d& center, const BoxEvidence& e) {
  const double distance = std::max(center.norm(), kLeastContactDistance_m);
  const double leftwards = (center.x() * axis.y() - center.y() * axis.x()) / distance;
  if (std::abs(leftwards) > kSideways && (e.cut.left || e.cut.right))
    return {e.cut.left && e.cut.right ? 0.0 : (leftwards > 0) == e.cut.left ? 1.0 : -1.0, true};
  return {axis.dot(center) > 0 ? 1.0 : -1.0, false};
}

// The front is the rectangle's first axis, turned by `quarter` right angles.
PlacedShape fromRectangle(const FootprintRectangle& r, int quarter, const BoxEvidence& e) {
  const ObjectModel& m = *e.model;
  const double yaw = r.yaw + quarter * std::numbers::pi / 2;
  const Eigen::Vector2d front(std::cos(yaw), std::sin(yaw)), left(-front.y(), front.x());
  const double along = quarter % 2 ? r.size_second : r.size_first,
               across = quarter % 2 ? r.size_first : r.size_second;
  const double x = front.dot(r.center), y = left.dot(r.center);
  const AxisFit depth = fitAxis(x, along, m.depth_m, m.depth_sigma_m, unseenPartOf(front, r.center, e));
  const AxisFit width = fitAxis(y, across, m.width_m, m.width_sigma_m, unseenPartOf(left, r.center, e));
  const Eigen::Vector2d center = front * depth.center + left * width.center;
  PlacedShape placed = usualShape(e);
  placed.shape.depth = depth.size;
  placed.shape.width = width.size;
  placed.x = center.x();
  placed.y = center.y();
  placed.yaw = wrapAngle(yaw);
  placed.has_yaw = true;
  placed.source = "depth";
  return placed;
}

std::vector<PlacedShape> guessesFromDepth(const BoxEvidence& e) {
  std::vector<Eigen::Vector2d> points;
  const std::size_t step = 1 + e.mask.points.size() / kFootprintPoints;
  for (std::size_t i = 0; i < e.mask.points.size(); i += step)
    points.push_back(e.mask.points[i].in_ground.head<2>());
  std::vector<PlacedShape> out;
  const int turns = e.model->symmetry == 1 ? 4 : (e.model->symmetry == 2 ? 2 : 1);
  for (const auto& rectangle : fitRectangles(points, e.faces))
    for (int quarter = 0; quarter < turns; ++quarter) out.push_back(fromRectangle(rectangle, quarter, e));
  return out;
}

// Without depth: the nearest corner or side meets the ground at the box's bottom; yaw is sampled relative to the
// viewing direction, and the fit to the box's sides decides.
std::vector<PlacedShape> guessesFromContact(const BoxEvidence& e) {
  std::vector<PlacedShape> out;
  const auto contact = contactPoint(e);
  if (!contact || contact->norm() < kLeastContactDistance_m || !e.model->rests_on_ground) return out;
  const Eigen::Vector2d ahead = contact->normalized();
  for (int k = 0; k < kContactYaws; ++k) {
    PlacedShape placed = usualShape(e);
    placed.yaw =
        wrapAngle(std::atan2(ahead.y(), ahead.x()) + std::numbers::pi + 2 * k * std::numbers::pi / kContactYaws);
    double reach = 0;
    for (const auto& corner : footprintAt({0, 0, placed.yaw}, placed.shape))
      reach = std::max(reach, ahead.dot(corner));
    const Eigen::Vector2d center = *contact + ahead * reach;
    placed.x = center.x();
    placed.y = center.y();
    placed.has_yaw = true;
    placed.source = "contact";
    out.push_back(placed);
  }
  return out;
}

// Without depth and visible bottom: at the range where the usual width is as wide as the box, front to the camera.
std::vector<PlacedShape> guessFromSize(const BoxEvidence& e) {
  if (e.cut.left || e.cut.right || halfAngleOf(e) < kLeastHalfAngle_rad) return {};
  const double bearing = bearingOf(e),
               range = e.model->width_m / 2 / std::tan(halfAngleOf(e)) + e.model->depth_m / 2;
  PlacedShape placed = usualShape(e);
  placed.x = range * std::cos(bearing);
  placed.y = range * std::sin(bearing);
  placed.yaw = wrapAngle(bearing + std::numbers::pi);
  placed.has_yaw = true;
  placed.source = "size";
  return {placed};
}

std::vector<PlacedShape> cuboidGuesses(const BoxEvidence& e) {
  if (!e.mask.points.empty()) return guessesFromDepth(e);
  auto guesses = cuboidsFromCorners(e);
  for (const auto& more : {guessesFromContact(e), guessFromSize(e)})
    guesses.insert(guesses.end(), more.begin(), more.end());
  return guesses;
}

}  // namespace

std::vector<PlacedShape> CuboidGenerator::generate(const BoxEvidence& evidence,
                                                   const GeneratorLimits& limits) const {
  if (!heightKnown(evidence)) return {};
  auto guesses = cuboidGuesses(evidence);
  for (PlacedShape& guess : guesses) judge(guess, evidence);
  const bool blind = evidence.mask.points.empty();
  const GeneratorLimits starts{limits.max_count + 1, 0, nullptr};
  std::vector<PlacedShape> fitted;
  for (const PlacedShape& guess : keepBest(guesses, blind ? kBlindStarts : SamePlace{0, 0}, starts))
    fitted.push_back(fitShape(guess, evidence));
  return keepBest(fitted, {}, limits);
}

}  // namespace roomgraph
