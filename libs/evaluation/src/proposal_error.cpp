// SPDX-License-Identifier: BSD-3-Clause
// Centre, yaw and 3D IoU errors, normalised estimation error (NEES), and their summaries per class.
#include "roomgraph/evaluation/proposal_error.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "roomgraph/geometry/degree.h"
#include "roomgraph/geometry/shape_math.h"

namespace roomgraph {
namespace {

constexpr double kGoodIou = 0.4;

double yawError(const Pose3& ground_from_a, const Pose3& ground_from_b, int symmetry) {
  const double difference = planarPart(ground_from_a).yaw - planarPart(ground_from_b).yaw;
  return std::abs(wrapAngle(difference * symmetry)) / symmetry * kDegreesPerRadian;
}

// Errors of a class, to be summarised.
struct Samples {
  std::vector<double> center_top, center_best, yaw_top, yaw_best, iou_top, iou_best, nees, sigma;
  Eigen::Vector2d along_sum = Eigen::Vector2d::Zero();
};

void addTop(const ProposalError& e, const Proposal& p, Samples& s) {
  s.along_sum += e.in_view;
  s.nees.push_back(e.nees);
  s.sigma.push_back(std::sqrt(p.covariance.topLeftCorner<2, 2>().trace() / 2));
  s.center_top.push_back(e.center.norm());
  s.yaw_top.push_back(e.yaw_deg);
  s.iou_top.push_back(e.iou3d);
}

void addCase(const ProposalCase& c, Samples& s) {
  double center = 1e9, yaw = 1e9, overlap = 0;
  for (std::size_t i = 0; i < c.proposals.size(); ++i) {
    const ProposalError e = errorOf(c.proposals[i], c);
    if (i == 0) addTop(e, c.proposals[i], s);
    center = std::min(center, e.center.norm());
    yaw = std::min(yaw, e.yaw_deg);
    overlap = std::max(overlap, e.iou3d);
  }
  s.center_best.push_back(center);
  s.yaw_best.push_back(yaw);
  s.iou_best.push_back(overlap);
}

double shareAbove(const std::vector<double>& values, double limit, int of) {
  const auto count = std::count_if(values.begin(), values.end(), [&](double x) { return x > limit; });
  return of > 0 ? static_cast<double>(count) / of : 0;
}

ProposalFigures figuresOf(const Samples& s, int detections) {
  ProposalFigures f;
  f.detections = detections;
  f.without_proposal = detections - static_cast<int>(s.iou_top.size());
  f.center_top_m = summarize(s.center_top);
  f.center_best_m = summarize(s.center_best);
  f.yaw_top_deg = summarize(s.yaw_top);
  f.yaw_best_deg = summarize(s.yaw_best);
  f.iou3d_top_median = summarize(s.iou_top).median;
  f.iou3d_best_median = summarize(s.iou_best).median;
  f.share_good = shareAbove(s.iou_best, kGoodIou, detections);
  if (!s.iou_top.empty()) f.away_mean_m = s.along_sum.x() / static_cast<double>(s.iou_top.size());
  if (!s.iou_top.empty()) f.left_mean_m = s.along_sum.y() / static_cast<double>(s.iou_top.size());
  f.nees_mean = summarize(s.nees).mean;
  f.nees_median = summarize(s.nees).median;
  f.sigma_m = summarize(s.sigma);
  return f;
}

// Normalised squared error of the tilts about two axes in the plane and of the height; the covariance of
// (normal, offset) has rank 3.
double groundNees(const GroundEstimate& estimate, const Plane& truth) {
  const Eigen::Vector3d n = truth.normal;
  const Eigen::Vector3d first = n.unitOrthogonal(), second = n.cross(first);
  Eigen::Matrix<double, 3, 4> reduce = Eigen::Matrix<double, 3, 4>::Zero();
  reduce.block<1, 3>(0, 0) = first.transpose();
  reduce.block<1, 3>(1, 0) = second.transpose();
  reduce(2, 3) = 1;
  Eigen::Vector4d difference;
  difference << estimate.plane.normal - n, estimate.plane.offset - truth.offset;
  const Eigen::Vector3d e = reduce * difference;
  return e.dot((reduce * estimate.covariance * reduce.transpose()).inverse() * e);
}

}  // namespace

ProposalError errorOf(const Proposal& p, const ProposalCase& c) {
  const Pose3 ground_from_camera = c.camera_from_ground.inverse();
  const Pose3 estimate = ground_from_camera * p.camera_from_object,
              truth = ground_from_camera * c.camera_from_truth;
  ProposalError e;
  e.center = (estimate.translation() - truth.translation()).head<2>();
  const Eigen::Vector2d place = estimate.translation().head<2>(), ahead = place.normalized();
  Eigen::Matrix2d view_from_ground;
  view_from_ground << ahead.x(), ahead.y(), -ahead.y(), ahead.x();
  const Eigen::Matrix2d covariance = p.covariance.topLeftCorner<2, 2>();
  e.in_view = view_from_ground * e.center;
  e.sigma_in_view =
      (view_from_ground * covariance * view_from_ground.transpose()).diagonal().cwiseMax(0).cwiseSqrt();
  e.in_object = (c.camera_from_truth.inverse() * p.camera_from_object).translation().head<2>();
  e.size = sizeOf(p.shape) - sizeOf(c.truth);
  e.nees = e.center.dot(covariance.inverse() * e.center);
  e.range_m = place.norm();
  if (c.rule.symmetry > 0) e.yaw_deg = yawError(estimate, truth, c.rule.symmetry);
  e.iou3d = iou3d(p.shape, estimate, c.truth, truth);
  return e;
}

std::map<std::string, ProposalFigures> evaluateProposals(const std::vector<ProposalCase>& cases) {
  std::map<std::string, Samples> samples;
  std::map<std::string, int> detections;
  for (const ProposalCase& c : cases) {
    ++detections[c.class_name];
    if (!c.proposals.empty()) addCase(c, samples[c.class_name]);
  }
  std::map<std::string, ProposalFigures> out;
  for (const auto& [name, count] : detections) out[name] = figuresOf(samples[name], count);
  return out;
}

GroundFigures evaluateGround(const std::vector<GroundCase>& cases) {
  GroundFigures f;
  std::vector<double> angles, heights, nees;
  int good = 0;
  for (const GroundCase& c : cases) {
    ++f.frames;
    if (!c.estimate || !c.estimate->from_depth) continue;
    ++f.found;
    const Plane& plane = c.estimate->plane;
    angles.push_back(std::acos(std::clamp(plane.normal.dot(c.truth.normal), -1.0, 1.0)) * kDegreesPerRadian);
    heights.push_back(std::abs(plane.offset - c.truth.offset));
    nees.push_back(groundNees(*c.estimate, c.truth));
    good += angles.back() <= 1 && heights.back() <= 0.02;
    f.wrong += angles.back() > 3 || heights.back() > 0.1;
  }
  f.angle_deg = summarize(angles);
  f.height_m = summarize(heights);
  f.share_good = f.found > 0 ? static_cast<double>(good) / f.found : 0;
  f.nees_mean = summarize(nees).mean;
  return f;
}

}  // namespace roomgraph
