// SPDX-License-Identifier: BSD-3-Clause
// Forgetting, matching by semantic codes and extension of object chains.
#include "object_window.h"

#include <utility>

namespace roomgraph {
namespace {

void forget(std::vector<ObjectChain>& objects, int oldest) {
  for (auto& object : objects)
    while (!object.sightings.empty() && object.sightings.front().frame < oldest) object.sightings.pop_front();
  std::erase_if(objects, [](const ObjectChain& object) { return object.sightings.empty(); });
}

// The window's objects at their predicted places; `places` holds the index of each in the window.
std::vector<LabelledBox> expected(const std::vector<ObjectChain>& objects, const Viewpoint& view,
                                  std::vector<int>& places) {
  std::vector<LabelledBox> boxes;
  for (std::size_t i = 0; i < objects.size(); ++i)
    if (const auto box = predictedBox(objects[i].sightings.back(), view)) {
      boxes.push_back({*box, objects[i].label});
      places.push_back(static_cast<int>(i));
    }
  return boxes;
}

Eigen::MatrixXd overlaps(const std::vector<LabelledBox>& a, const std::vector<LabelledBox>& b) {
  Eigen::MatrixXd out(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i)
    for (std::size_t k = 0; k < b.size(); ++k)
      out(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k)) = iou(a[i].box, b[k].box);
  return out;
}

double likeness(const SemanticCode& a, const SemanticCode& b) {
  return matchCodes(a, b, Eigen::MatrixXd::Zero(a.labels.size(), b.labels.size())).beta;
}

void extend(ObjectChain& object, Sighting sighting, const WindowStep& step, double link_weight) {
  const Sighting& before = object.sightings.back();
  const double likeness = before.frame + 1 == sighting.frame ? step.beta : step.beta_star;
  const double weight = featureShare(before.features, sighting.features) * (link_weight + 1 - likeness);
  sighting.pairwise = pairwiseEnergies(before, sighting, weight);
  object.sightings.push_back(std::move(sighting));
}

}  // namespace

WindowStep advance(ObjectWindow& window, std::vector<Sighting> sightings,
                   const std::vector<std::uint8_t>& labels, const Viewpoint& view,
                   const WindowOptions& options) {
  WindowStep step;
  std::vector<LabelledBox> seen;
  for (std::size_t k = 0; k < sightings.size(); ++k) seen.push_back({sightings[k].box, labels[k]});
  const SemanticCode code = semanticCode(seen);
  if (window.frame > 0) step.beta = likeness(window.code, code);
  forget(window.objects, ++window.frame - options.frames + 1);

  std::vector<int> places;
  const std::vector<LabelledBox> boxes = expected(window.objects, view, places);
  const SemanticCode together = semanticCode(boxes);
  const Eigen::MatrixXd overlap = overlaps(boxes, seen);
  const CodeMatch match = matchCodes(together, code, overlap);
  step.beta_star = match.beta;
  const std::vector<int> links =
      identityLinks(together, code, match, overlap, options.min_overlap, options.order_bonus);

  for (std::size_t k = 0; k < sightings.size(); ++k) {
    Sighting& sighting = sightings[k];
    sighting.frame = window.frame;
    if (links[k] >= 0) {
      step.objects.push_back(places[static_cast<std::size_t>(links[k])]);
      extend(window.objects[static_cast<std::size_t>(step.objects.back())], std::move(sighting), step,
             options.link_weight);
    } else {
      step.objects.push_back(static_cast<int>(window.objects.size()));
      window.objects.push_back({TrackId{window.next_track++}, labels[k], window.frame, {}});
      window.objects.back().sightings.push_back(std::move(sighting));
    }
  }
  window.code = code;
  return step;
}

}  // namespace roomgraph
