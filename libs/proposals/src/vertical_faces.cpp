// SPDX-License-Identifier: BSD-3-Clause
// Normals by principal components of neighbouring samples.
#include "vertical_faces.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include "plane_fit.h"

namespace roomgraph {
namespace {

constexpr int kReach = 2;                 // samples to each side that count as neighbours …
constexpr double kNear_m = 0.12, kNearPerNoise = 3;  // … when they are this near: a constant, and by the depth noise
constexpr std::size_t kLeastNeighbours = 8;
constexpr double kFlat_m = 0.008, kFlatPerNoise = 1.5;  // standard deviation across a plane: a constant, by the noise
constexpr double kLeastExtent = 2;        // of a plane's narrower side against that deviation
constexpr double kVertical = 0.35;        // sine of the largest tilt of a face that counts as vertical
constexpr double kFaceSigma_rad = 0.12;   // of a normal's direction

constexpr double kFewFaces = 20;          // points that say half of what many say
constexpr double kQuarter = std::numbers::pi / 2;
constexpr int kDirections = 45;           // in which the best pair is looked for

using PixelSample = std::pair<int, int>;

// Pixels from one sample to the next.
double strideOf(const std::vector<MaskPoint>& points) {
  double stride = 0;
  for (std::size_t i = 1; i < points.size(); ++i) {
    const double step = std::abs(points[i].u - points[i - 1].u);
    if (step > 0 && (stride == 0 || step < stride)) stride = step;
  }
  return stride;
}

double meanAgreement(const std::vector<double>& azimuths, double yaw) {
  double sum = 0;
  for (const double azimuth : azimuths) {
    const double off = std::remainder(azimuth - yaw, kQuarter) / kFaceSigma_rad;
    sum += std::exp(-off * off / 2);
  }
  return azimuths.empty() ? 0 : sum / static_cast<double>(azimuths.size());
}

}  // namespace

VerticalFaces verticalFaces(const std::vector<MaskPoint>& points) {
  VerticalFaces out;
  const double stride = strideOf(points);
  if (stride == 0) return out;
  const auto sampleAt = [&](const MaskPoint& p) {
    return PixelSample{static_cast<int>(std::lround(p.u / stride)), static_cast<int>(std::lround(p.v / stride))};
  };
  std::map<PixelSample, const MaskPoint*> grid;
  for (const auto& p : points) grid[sampleAt(p)] = &p;
  std::vector<Eigen::Vector3d> near;
  for (const auto& [at, point] : grid) {
    const Eigen::Vector3d& here = point->in_ground;
    const double noise = depthSigma(here.norm()), reach = kNear_m + kNearPerNoise * noise;
    near.clear();
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (int dv = -kReach; dv <= kReach; ++dv)
      for (int du = -kReach; du <= kReach; ++du) {
        const auto found = grid.find({at.first + du, at.second + dv});
        if (found == grid.end() || (found->second->in_ground - here).norm() > reach) continue;
        near.push_back(found->second->in_ground);
        mean += near.back();
      }
    if (near.size() < kLeastNeighbours) continue;
    mean /= static_cast<double>(near.size());
    Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
    for (const auto& q : near) scatter += (q - mean) * (q - mean).transpose();
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
    solver.computeDirect(scatter / static_cast<double>(near.size()));
    const Eigen::Vector3d deviation = solver.eigenvalues().cwiseMax(0).cwiseSqrt();
    const Eigen::Vector3d normal = solver.eigenvectors().col(0);
    if (deviation[0] > kFlat_m + kFlatPerNoise * noise || deviation[1] < kLeastExtent * deviation[0] ||
        std::abs(normal.z()) > kVertical)
      continue;
    out.azimuths.push_back(std::atan2(normal.y(), normal.x()));
  }
  for (int k = 0; k < kDirections; ++k)
    out.most = std::max(out.most, meanAgreement(out.azimuths, k * kQuarter / kDirections));
  return out;
}

double faceAgreement(const VerticalFaces& faces, double yaw) {
  if (faces.most <= 0) return 1;
  const double count = static_cast<double>(faces.azimuths.size()), known = count / (count + kFewFaces);
  return 1 - known + known * std::min(1.0, meanAgreement(faces.azimuths, yaw) / faces.most);
}

}  // namespace roomgraph
