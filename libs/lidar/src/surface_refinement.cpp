// SPDX-License-Identifier: BSD-3-Clause
// Iterated association of returns with lines, and the solution for the pose.
#include "surface_refinement.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace roomgraph {
namespace {

constexpr int kIterations = 12;
constexpr double kLeastSigma_m = 0.01;                // of a return and the unevenness of its surface
constexpr double kRobustWidth = 2, kFarthest = 4;     // standard deviations; Cauchy
constexpr double kOnSurface = 2.5;                    // standard deviations
constexpr double kLeastShare = 1.0 / 3;
constexpr double kStill_m = 3e-5, kStill_rad = 1e-5;  // smaller steps end the iterations
constexpr double kFarthestFromGrid_m = 1;             // farther away it is another place
constexpr double kSeeming = 2;                        // times the scatter of the normals that is told of
constexpr double kSomethingInIt = 0.2;                // share of it that counts where nothing but the scan measures
constexpr double kSlip = 3;                           // standard deviations between scan and prediction; Geman and McClure

// Of a return across its line.
double varianceOf(const SurfaceLine& line) {
  return kLeastSigma_m * kLeastSigma_m + line.variance_m2;
}

struct NormalEquations {
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
  Eigen::Matrix3d seeming = Eigen::Matrix3d::Zero();  ///< part of the information: that normals of one wall differ by chance
  std::size_t used = 0;
  std::vector<LineError> errors;
};

// What each return counts for. Beams that end close to each other see one piece of a surface and err alike: a wall beside the
// lidar, with a hundred returns on a metre, would outweigh all that is farther away, from which the direction is known. Of
// n returns of variance v on kAlike_m the mean has the variance v (own / n + 1 - own).
std::vector<double> sharesOf(const Points2& points, double own) {
  std::vector<double> out(points.size());
  double before = kAlike_m;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double after = i + 1 < points.size() ? std::min(kAlike_m, (points[i + 1] - points[i]).norm()) : kAlike_m;
    const double one_of = std::max(1e-3, (before + after) / (2 * kAlike_m));  // 1 / n
    out[i] = 1 / (own + (1 - own) / one_of);
    before = after;
  }
  return out;
}

NormalEquations linearise(LinesOfReturns& lines, const FacedScan& scan, const std::vector<double>& shares, const Pose2& pose,
                          int levels) {
  NormalEquations out;
  out.errors.resize(scan.points.size());
  const double c = std::cos(pose.yaw), s = std::sin(pose.yaw);
  for (std::size_t i = 0; i < scan.points.size(); ++i) {
    const Eigen::Vector2d& p = scan.points[i];
    const Eigen::Vector2d turned(c * p.x() - s * p.y(), s * p.x() + c * p.y());
    const Eigen::Vector2d at = turned + Eigen::Vector2d(pose.x, pose.y);
    const SurfaceLine* line = lines.around(i, at, scan.facing_rad[i] + pose.yaw, levels);
    if (!line) continue;
    const double distance = line->normal.dot(at - line->mean);
    const double variance = varianceOf(*line);
    const double squared = distance * distance / variance;
    if (squared > kFarthest * kFarthest) continue;
    const double weight = shares[i] / (variance * (1 + squared / (kRobustWidth * kRobustWidth)));
    const Eigen::Vector3d jacobian(line->normal.x(), line->normal.y(),
                                   line->normal.y() * turned.x() - line->normal.x() * turned.y());
    out.information += weight * jacobian * jacobian.transpose();
    out.gradient += weight * distance * jacobian;
    const Eigen::Vector3d along(-jacobian.y(), jacobian.x(), jacobian.x() * turned.x() + jacobian.y() * turned.y());
    out.seeming += kSeeming * weight * line->turn_rad2 * along * along.transpose();
    out.errors[i] = {true, distance / std::sqrt(variance), line->normal};
    ++out.used;
  }
  return out;
}

// Least curvature by the place, along any direction.
double weakest(const Eigen::Matrix3d& m) {
  return (m(0, 0) + m(1, 1)) / 2 - std::hypot((m(0, 0) - m(1, 1)) / 2, m(0, 1));
}

// Along a plain wall the normals of its pieces scatter to both sides, as if something held the scan there. What is left of the
// information is positive: some metres are known of any match.
Eigen::Matrix3d withoutSeeming(const NormalEquations& equations) {
  constexpr double kReach_m = 5, kLeast = 0.1;  // to compare turns with shifts; 1/m^2
  const Eigen::Vector3d scale(1, 1, kReach_m);
  const Eigen::Matrix3d scaled = scale.cwiseInverse().asDiagonal() * (equations.information - equations.seeming) * scale.cwiseInverse().asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> parts(scaled);
  const Eigen::Matrix3d positive =
      parts.eigenvectors() * parts.eigenvalues().cwiseMax(kLeast).asDiagonal() * parts.eigenvectors().transpose();
  return scale.asDiagonal() * positive * scale.asDiagonal();
}

Eigen::Matrix3d matrixOf(const PosePrior& prior) {
  Eigen::Matrix3d out =
      Eigen::Vector3d(prior.weight_per_m2, prior.weight_per_m2, prior.weight_per_rad2).asDiagonal();
  out.topLeftCorner<2, 2>() += prior.extra_weight_per_m2;
  return out;
}

// What normals that scatter hold and pull at along a wall counts by the share of the information there that is more than seeming, and
// by `least` anyway.
void discountSeeming(double least, NormalEquations& equations) {
  const Eigen::Matrix3d real = withoutSeeming(equations);
  const Eigen::Matrix3d share = real * (real + equations.seeming).inverse();  // exact returns leave nothing along a wall: no inverse of that
  const Eigen::Matrix3d counted = share * real;
  equations.gradient = (1 - least) * share * equations.gradient + least * equations.gradient;
  equations.information = (1 - least) / 2 * (counted + counted.transpose()) + least * equations.information;
}

// How much a prediction counts that the scan contradicts: wheels slip. Compared is what the scan alone would say, as sure as it is.
double trustIn(const PosePrior& prior, const NormalEquations& scan, const Eigen::Vector3d& shift) {
  if (!prior.may_slip) return 1;
  const Eigen::Matrix3d covariance = scan.information.inverse();
  const Eigen::Vector2d apart = (shift - covariance * scan.gradient).head<2>();
  const Eigen::Matrix2d both = covariance.topLeftCorner<2, 2>() + prior.information_per_m2.inverse();
  const double surprise = 1 + apart.dot(both.inverse() * apart) / (kSlip * kSlip);
  return 1 / (surprise * surprise);
}

std::optional<SurfaceFit> refineOn(LinesOfReturns& lines, int levels, const FacedScan& scan, const GridRefinement& grid,
                                   const PosePrior& prior, const OwnShare& own) {
  const Eigen::Matrix3d unscaled = matrixOf(prior);
  const std::vector<double> shares = sharesOf(scan.points, own.value());
  SurfaceFit fit{.map_from_scan = grid.grid_from_scan};
  Pose2& pose = fit.map_from_scan;
  NormalEquations scan_only;
  for (int i = 0; i < kIterations; ++i) {
    scan_only = linearise(lines, scan, shares, pose, levels);
    if (static_cast<double>(scan_only.used) < kLeastShare * static_cast<double>(scan.points.size())) return std::nullopt;
    const double scale = weakest(scan_only.information) / std::max(1e-6, weakest(grid.mean_curvature));
    const Eigen::Vector3d shift(pose.x - prior.pose.x, pose.y - prior.pose.y, wrapAngle(pose.yaw - prior.pose.yaw));
    Eigen::Matrix3d weight = std::max(0.0, scale) * unscaled + 1e-6 * Eigen::Matrix3d::Identity();
    NormalEquations counted = scan_only;
    if (prior.information_per_m2.trace() > 0) {
      discountSeeming(prior.may_slip ? 0 : kSomethingInIt, counted);
      fit.trust = trustIn(prior, counted, shift);
      weight.topLeftCorner<2, 2>() += fit.trust * prior.information_per_m2;
    }
    const Eigen::Vector3d step = -(counted.information + weight).ldlt().solve(counted.gradient + weight * shift);
    pose = {pose.x + step.x(), pose.y + step.y(), wrapAngle(pose.yaw + step.z())};
    if (step.head<2>().norm() < kStill_m && std::abs(step.z()) < kStill_rad) break;
  }
  fit.information = withoutSeeming(scan_only);
  fit.neighbours = neighbourErrors(scan.points, scan_only.errors);
  return fit;
}

}  // namespace

std::optional<SurfaceFit> refineOnSurfaces(const LocalSurfaces& surfaces, const FacedScan& scan, const GridRefinement& grid,
                                           const PosePrior& prior, const OwnShare& own) {
  LinesOfReturns lines(surfaces, scan.points.size());
  const auto fit = refineOn(lines, LocalSurfaces::kUsual, scan, grid, prior, own);
  return fit ? fit : refineOn(lines, LocalSurfaces::kAll, scan, grid, prior, own);
}

double shareOnWrongSide(const LocalSurfaces& surfaces, const FacedScan& scan, const Pose2& map_from_scan) {
  const auto isOn = [&](const Eigen::Vector2d& at, double facing_rad) {
    const auto line = surfaces.around(at, facing_rad);
    if (!line) return false;
    const double distance = line->normal.dot(at - line->mean);
    return distance * distance < kOnSurface * kOnSurface * varianceOf(*line);
  };
  int right = 0, wrong = 0;
  const FacedScan placed = transformed(map_from_scan, scan);
  for (std::size_t i = 0; i < placed.points.size(); ++i) {
    if (isOn(placed.points[i], placed.facing_rad[i])) {
      ++right;
    } else if (isOn(placed.points[i], placed.facing_rad[i] + std::numbers::pi)) {
      ++wrong;
    }
  }
  return wrong > 0 ? static_cast<double>(wrong) / (right + wrong) : 0;
}

void refineFurther(const LocalSurfaces& surfaces, const FacedScan& scan, const PosePrior& prior, OwnShare& own,
                   GridRefinement& refinement) {
  const auto fit = refineOnSurfaces(surfaces, scan, refinement, prior, own);
  if (!fit) return;
  const Pose2 moved = refinement.grid_from_scan.inverse() * fit->map_from_scan;
  if (std::hypot(moved.x, moved.y) > kFarthestFromGrid_m) return;
  own.learn(fit->neighbours);
  refinement.grid_from_scan = fit->map_from_scan;
  refinement.curvature = fit->information;
  refinement.residual_variance = 1;
  refinement.on_surfaces = true;
  refinement.trust = fit->trust;
}

}  // namespace roomgraph
