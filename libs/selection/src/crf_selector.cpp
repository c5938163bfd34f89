// SPDX-License-Identifier: BSD-3-Clause
// Chains of the newest frame's objects minimised, with marginals as confidence.
#include "crf_selector.h"

#include <limits>

namespace roomgraph {

IMPLEMENTS_MRPT_OBJECT(CrfSelector, ProposalSelector, roomgraph)

namespace {

std::vector<std::vector<const Proposal*>> byDetection(const FrameProposals& frame) {
  std::vector<std::vector<const Proposal*>> out(frame.detections.size());
  for (const auto& proposal : frame.proposals)
    if (proposal.detection >= 0 && proposal.detection < static_cast<int>(out.size()))
      out[static_cast<std::size_t>(proposal.detection)].push_back(&proposal);
  return out;
}

// States of least energy, with only those proposals in the newest frame whose own energy is low enough.
ChainSolution minimizeReportable(ChainProblem problem, double max_energy) {
  auto& newest = problem.unary.back();
  for (std::size_t x = 1; x < newest.size(); ++x)
    if (newest[x] > max_energy) newest[x] = std::numeric_limits<double>::infinity();
  return minimize(problem);
}

}  // namespace

CrfSelector::CrfSelector() : window_(std::make_unique<ObjectWindow>()) {}
CrfSelector::~CrfSelector() = default;

void CrfSelector::declareParameters(ParameterVisitor& v) {
  options_.declare(v);
  v.add("window_frames", window_options_.frames,
        {.doc = "Number N of frames in the window. An object that was missed for as many gets a new track.",
         .min = 2,
         .max = 100});
  v.add("min_link_overlap", window_options_.min_overlap,
        {.doc = "A box continues a track only when its IoU with the predicted box is at least this.",
         .min = 0.01,
         .max = 1});
  v.add("order_bonus", window_options_.order_bonus,
        {.doc = "Added to the IoU of a box with a predicted one where the codes' index map gamma links them.",
         .min = 0,
         .max = 1});
  v.add("link_weight", window_options_.link_weight,
        {.doc = "The pairwise term (Eq. 6) weighs s * (this + 1 - beta). 0: the paper's weight, which is 0 "
                "while the labels in view stay the same.",
         .min = 0,
         .max = 1});
  v.add(
      "none_competes", none_competes_,
      {.doc = "Selecting nothing has the energy max_energy, so that an object followed for a whole window is "
              "selected though weak (Eq. 7). no: every proposal must reach max_energy by itself."});
}

std::vector<ObjectMeasurement> CrfSelector::select(const FrameProposals& frame, const FrameContext& context) {
  const Viewpoint view{context.camera, context.world_from_camera};
  const auto proposals = byDetection(frame);
  std::vector<Sighting> sightings;
  std::vector<std::uint8_t> labels;
  for (std::size_t j = 0; j < frame.detections.size(); ++j) {
    sightings.push_back(makeSighting(frame.detections[j], proposals[j], view, context.features));
    labels.push_back(window_->codes.of(frame.detections[j].class_name));
  }
  const WindowStep step = advance(*window_, std::move(sightings), labels, view, window_options_);

  std::vector<ObjectMeasurement> selected;
  for (std::size_t j = 0; j < frame.detections.size(); ++j) {
    const ObjectChain& object = window_->objects[static_cast<std::size_t>(step.objects[j])];
    const bool whole_window = window_->frame - object.born + 1 >= window_options_.frames;
    const ChainProblem chain = chainProblem(object, whole_window, none_competes_ ? options_.max_energy : 0);
    const ChainSolution solution =
        none_competes_ ? minimize(chain) : minimizeReportable(chain, options_.max_energy);
    if (solution.states.empty() || solution.states.back() == 0) continue;
    const int state = solution.states.back();
    const Proposal& proposal = *proposals[j][static_cast<std::size_t>(state - 1)];
    ObjectMeasurement measurement{frame.frame, frame.t, frame.detections[j], proposal};
    measurement.confidence = marginals(chain, options_.temperature).back()[static_cast<std::size_t>(state)];
    measurement.energy.unary = chain.unary.back()[static_cast<std::size_t>(state)];
    if (!chain.pairwise.empty())
      measurement.energy.pairwise = chain.pairwise.back()(solution.states.end()[-2], state);
    measurement.track = object.id;
    measurement.beta = step.beta;
    measurement.features = featuresOnObject(context.features, frame.detections[j].box, proposal,
                                            context.camera, kFeatureMargin_m);
    selected.push_back(std::move(measurement));
  }
  return selected;
}

}  // namespace roomgraph
