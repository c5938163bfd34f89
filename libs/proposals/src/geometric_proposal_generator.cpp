// SPDX-License-Identifier: BSD-3-Clause
// Evidence, hypotheses, scores and covariances of one frame; other explanations of misleading depth.
#include "geometric_proposal_generator.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "gather_evidence.h"
#include "initial_score.h"
#include "proposal_covariance.h"

namespace roomgraph {

IMPLEMENTS_MRPT_OBJECT(GeometricProposalGenerator, ProposalGenerator, roomgraph)

namespace {

constexpr double kDoubtful = 0.8;     // quality below which other explanations of the depth are tried
constexpr double kUnsupported = 0.7;  // factor on the quality of a shape that ignores the depth points

// Largest standard deviation of the ground's normal.
double tiltSigma(const GroundEstimate& ground) {
  const Eigen::Matrix3d covariance = ground.covariance.topLeftCorner<3, 3>();
  return std::sqrt(std::max(0.0, covariance.diagonal().maxCoeff()));
}

// Share of the box in which something stands clearly before the shape, and is what the detector saw.
double obscured(const PlacedShape& placed, const BoxEvidence& e) {
  constexpr double kBefore_m = 0.3;
  const double front = std::hypot(placed.x, placed.y) - placed.shape.radius() - kBefore_m;
  const auto before = std::count_if(e.all.points.begin(), e.all.points.end(), [&](const MaskPoint& p) {
    return p.in_ground.z() > kStanding_m && p.in_ground.head<2>().norm() < front;
  });
  return e.all.points.empty()
             ? 0
             : e.all.valid_ratio * static_cast<double>(before) / static_cast<double>(e.all.points.size());
}

// Off the quality of what goes on beyond the box all around, where another cluster does not.
constexpr double kGoingOn = 0.4;

// Proposals from the next depth cluster and without depth, for when the first cluster explains the box badly:
// it may be an occluder. `other`: the evidence with the next cluster, where there is one.
std::vector<PlacedShape> reconsidered(std::vector<PlacedShape> first, const BoxEvidence& evidence,
                                      const std::optional<BoxEvidence>& other, const Frame& frame,
                                      const ShapeGenerator& generator, const GeneratorLimits& limits) {
  std::vector<PlacedShape> all = std::move(first);
  if (other) {
    const double goes_further = std::max(0.0, other->mask.goes_on - evidence.mask.goes_on);
    for (PlacedShape placed : generator.generate(*other, limits)) {
      placed.other_cluster = true;
      placed.quality *= 1 - kGoingOn * goes_further;
      all.push_back(std::move(placed));
    }
  }
  for (PlacedShape placed : generator.generate(withMask(evidence, {}, frame), limits)) {
    placed.supported = false;
    placed.quality *= kUnsupported * (1 - obscured(placed, evidence));
    all.push_back(std::move(placed));
  }
  return keepBest(std::move(all), {}, limits);
}

// Nothing when the shape is out of view.
std::optional<Proposal> proposalOf(const PlacedShape& placed, const BoxEvidence& evidence,
                                   const InitialScore& start, double tilt_sigma) {
  const auto projected = project(placed, evidence);
  if (!projected) return std::nullopt;
  Proposal proposal;
  proposal.model = proposal.class_name = evidence.model->class_name;
  proposal.shape = placed.shape;
  proposal.size_information = placed.size_information;
  proposal.least_size_information = placed.least_size_information;
  proposal.place_by_size = placed.place_by_size;
  proposal.camera_from_object = cameraFromObject(placed, evidence);
  proposal.covariance = covarianceOf(placed, evidence, tilt_sigma);
  proposal.has_yaw = placed.has_yaw;
  proposal.projected = *projected;
  if (const auto seen = visibleBounds(placed, evidence)) proposal.projected.visible = *seen;
  proposal.score = std::clamp(start.value * placed.quality, 0.0, 1.0);
  proposal.box_iou = placed.box_iou;
  proposal.source = placed.source;
  char fit[96];
  std::snprintf(fit, sizeof fit, "; fit %.2f, IoU with the box %.2f, %zu depth points", placed.quality,
                placed.box_iou, placed.supported ? evidence.mask.points.size() : 0);
  proposal.reasons = start.text() + fit;
  return proposal;
}

ProposalTrace traceOf(int index, const BoxEvidence& evidence, const InitialScore& start,
                      const std::vector<PlacedShape>& rejected, double tilt_sigma) {
  ProposalTrace trace;
  for (const MaskPoint& p : evidence.mask.points) trace.mask_pixels.emplace_back(p.u, p.v);
  trace.segments = evidence.segments;
  for (const PlacedShape& placed : rejected)
    if (auto proposal = proposalOf(placed, evidence, start, tilt_sigma)) {
      proposal->detection = index;
      proposal->reasons = placed.reason;
      trace.rejected.push_back(std::move(*proposal));
    }
  return trace;
}

}  // namespace

void GeometricProposalGenerator::declareParameters(ParameterVisitor& v) {
  v.add("use_depth", use_depth_,
        {.doc = "Whether depth is used. false: box and ground alone, as without a depth camera "
                "([ground] class = ExpectedGroundDetector does the same for the ground)."});
  v.add("max_proposals", limits_.max_count, {.doc = "Proposals kept per detection.", .min = 1, .max = 5});
  v.add("min_box_iou", limits_.min_iou,
        {.doc = "Proposals whose projected shape has a smaller IoU with the box are dropped.",
         .min = 0,
         .max = 1});
}

void GeometricProposalGenerator::prepare() {
  if (database_ && generators_.empty()) generators_ = ShapeGenerators(*database_);
}

FrameProposals GeometricProposalGenerator::generate(const Frame& frame,
                                                    const std::vector<Detection>& detections,
                                                    const FrameGround& ground) {
  FrameProposals out;
  out.frame = frame.id;
  out.t = frame.t;
  out.detections = detections;
  out.ground = ground.estimate;
  out.ground_reason = ground.reason;
  Frame used = frame;
  if (!use_depth_) used.depth.release();
  if (keep_traces_) out.traces.resize(detections.size());
  if (!out.ground || !database_ || !frame.camera.valid()) return out;
  for (int i = 0; i < static_cast<int>(detections.size()); ++i) propose(used, i, out);
  return out;
}

void GeometricProposalGenerator::propose(const Frame& frame, int index, FrameProposals& out) const {
  const Detection& detection = out.detections[index];
  const ObjectModel* model = database_->find(detection.class_name);
  if (!model || clipped(detection.box, frame.camera.width, frame.camera.height).empty()) return;
  BoxEvidence evidence = gatherEvidence(frame, detection, *model, out.ground->plane);
  if (!out.ground->from_depth) evidence.ground_tilt_sigma = tiltSigma(*out.ground);
  const InitialScore start = initialScore(evidence);
  GeneratorLimits limits = limits_;
  std::vector<PlacedShape> rejected;
  if (keep_traces_) limits.rejected = &rejected;
  const ShapeGenerator& generator = generators_.of(*model);
  auto found = generator.generate(evidence, limits);
  std::optional<BoxEvidence> other;
  if (!evidence.mask.points.empty() && (found.empty() || found.front().quality < kDoubtful)) {
    if (!evidence.other_mask.points.empty()) other = withMask(evidence, evidence.other_mask, frame);
    found = reconsidered(std::move(found), evidence, other, frame, generator, limits);
  }
  const double tilt_sigma = tiltSigma(*out.ground);
  for (const PlacedShape& placed : found)
    if (auto proposal = proposalOf(placed, placed.other_cluster ? *other : evidence, start, tilt_sigma)) {
      proposal->detection = index;
      out.proposals.push_back(std::move(*proposal));
    }
  if (keep_traces_) out.traces[index] = traceOf(index, evidence, start, rejected, tilt_sigma);
}

}  // namespace roomgraph
