// SPDX-License-Identifier: BSD-3-Clause
// Detections, decisions and former sightings as JSON.
#include "frame_lines.h"

#include <limits>
#include <nlohmann/json.hpp>
#include <utility>

namespace roomgraph {
namespace {

using nlohmann::ordered_json;

ordered_json boxJson(const Box2& box) {
  return {box.u_min, box.v_min, box.u_max, box.v_max};
}

ordered_json posteriorJson(const WeightedLandmarks& posterior) {
  ordered_json out = ordered_json::array();
  for (const auto& [id, probability] : posterior)
    out.push_back({{"landmark", id.valid() ? ordered_json(id.value) : ordered_json("new")}, {"p", probability}});
  return out;
}

ordered_json decisionJson(const ObjectDecision& decision) {
  const auto& measurement = decision.seen.measurement;
  const Eigen::Vector3d place = decision.seen.world_from_object.translation();
  return {{"class", measurement.proposal.class_name},
          {"bbox", boxJson(measurement.detection.box)},
          {"landmark", decision.landmark.value},
          {"new", !decision.association.landmark.valid()},
          {"posterior", posteriorJson(decision.association.posterior)},
          {"track", measurement.track.value},
          {"beta", measurement.beta},
          {"confidence", measurement.confidence},
          {"world", {place.x(), place.y(), place.z()}},
          {"source", measurement.proposal.source},
          {"score", measurement.proposal.score},
          {"energy",
           {{"unary", measurement.energy.unary},
            {"pairwise", measurement.energy.pairwise},
            {"high_order", measurement.energy.high_order}}}};
}

ordered_json formerJson(const FormerSighting& sighting) {
  return {{"class", sighting.class_name},
          {"bbox", boxJson(sighting.box)},
          {"landmark", sighting.landmark.value},
          {"new", false},
          {"posterior", posteriorJson({{sighting.landmark, sighting.probability}})},
          {"given_up", true}};
}

std::string lineOf(double t, ordered_json measurements) {
  return textOf({{"timestamp", t}, {"measurements", std::move(measurements)}});
}

}  // namespace

std::string textOf(const ordered_json& json, int indent) {
  return json.dump(indent, ' ', false, ordered_json::error_handler_t::replace);
}

std::string detectionsLine(const StepReport& report) {
  ordered_json line{{"timestamp", report.t}, {"boxes", ordered_json::array()}};
  for (const auto& detection : report.detections.boxes) {
    line["boxes"].push_back(
        {{"class", detection.class_name}, {"score", detection.score}, {"bbox", boxJson(detection.box)}});
    if (detection.carried) line["boxes"].back()["carried"] = true;
    if (!detection.rival_label.empty())
      line["boxes"].back()["rival"] = {{"label", detection.rival_label}, {"score", detection.rival_score}};
  }
  if (report.detections.carried) line["carried"] = true;
  if (!report.detections.unsought.empty()) line["unsought"] = report.detections.unsought;
  return textOf(line);
}

std::string associationsLine(double t, const std::vector<ObjectDecision>& decisions) {
  ordered_json measurements = ordered_json::array();
  for (const auto& decision : decisions) measurements.push_back(decisionJson(decision));
  return lineOf(t, std::move(measurements));
}

void writeAssociations(std::ostream& out, const ObjectFrames& frames) {
  auto former = frames.former().begin();
  const auto end = frames.former().end();
  const auto writeFormerUntil = [&](double until) {
    while (former != end && former->t < until) {
      const double t = former->t;
      ordered_json measurements = ordered_json::array();
      for (; former != end && former->t == t; ++former) measurements.push_back(formerJson(*former));
      out << lineOf(t, std::move(measurements)) << '\n';
    }
  };
  for (const auto& frame : frames) {
    writeFormerUntil(frame.t);
    out << associationsLine(frame.t, frame.decisions) << '\n';
  }
  writeFormerUntil(std::numeric_limits<double>::infinity());
}

}  // namespace roomgraph
