// SPDX-License-Identifier: BSD-3-Clause
// JSON lines to sightings, boxes and pictures; candidates with their evidence.
#include "run_lines.h"

#include <algorithm>
#include <functional>
#include <iterator>
#include <nlohmann/json.hpp>

#include "roomgraph/core/base64.h"
#include "roomgraph/core/json_integer.h"
#include "roomgraph/core/text_file.h"

namespace roomgraph {
namespace {

using nlohmann::json;

void forEachLine(std::istream& lines, const std::string& name, const std::function<void(const json&)>& use) {
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
    try {
      use(json::parse(line));
    } catch (const std::exception& error) {
      throw InputError(name + ":" + std::to_string(number) + ": " + firstLine(error));
    }
  }
}

json wholeOf(std::istream& in, const std::string& name) {
  return parseJson<json>(std::string(std::istreambuf_iterator<char>(in), {}), name);
}

ShownSighting sightingOf(const json& entry, double t) {
  ShownSighting out{.landmark = LandmarkId{integerOf<std::int64_t>(entry.at("landmark"))},
                    .t = t,
                    .made_new = entry.at("new").get<bool>(),
                    .confidence = entry.value("confidence", 1.0),
                    .score = entry.value("score", 0.0),
                    .source = entry.value("source", "")};
  for (const json& likely : entry.at("posterior")) {
    const json& id = likely.at("landmark");
    out.posterior.emplace_back(id.is_number() ? LandmarkId{integerOf<std::int64_t>(id)} : LandmarkId{},
                               likely.at("p").get<double>());
    const auto& [landmark, probability] = out.posterior.back();
    if (landmark == (out.made_new ? LandmarkId{} : out.landmark)) out.probability += probability;
  }
  if (const auto energy = entry.find("energy"); energy != entry.end())
    out.energy = {energy->value("unary", 0.0), energy->value("pairwise", 0.0),
                  energy->value("high_order", 0.0)};
  return out;
}

Detection boxOf(const json& entry) {
  const json& box = entry.at("bbox");
  Detection out;
  out.class_name = entry.at("class").get<std::string>();
  out.score = entry.at("score").get<double>();
  out.box = {box.at(0).get<double>(), box.at(1).get<double>(), box.at(2).get<double>(),
             box.at(3).get<double>()};
  out.carried = entry.value("carried", false);
  return out;
}

Landmark candidateOf(const json& entry) {
  Landmark out;
  out.id.value = integerOf<std::int64_t>(entry.at("id"));
  out.class_name = entry.at("class").get<std::string>();
  out.model = entry.value("model", "");
  const json& size = entry.at("size_wdh");
  out.shape = {shapeKindFromString(entry.value("shape", "cuboid")), size.at(0).get<double>(),
               size.at(1).get<double>(), size.at(2).get<double>()};
  out.position = {entry.at("x").get<double>(), entry.at("y").get<double>(), entry.at("z").get<double>()};
  out.yaw = entry.at("yaw").get<double>();
  out.has_yaw = entry.value("has_yaw", true);
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column)
      out.covariance(row, column) = entry.at("covariance")
                                        .at(static_cast<std::size_t>(row))
                                        .at(static_cast<std::size_t>(column))
                                        .get<double>();
  out.existence = entry.at("existence").get<double>();
  entry.at("class_posterior").get_to(out.class_posterior);
  out.observations = integerOf<int>(entry, "observations", 0);
  return out;
}

}  // namespace

std::vector<ShownSighting> readSightingLines(std::istream& lines, const std::string& name) {
  std::vector<ShownSighting> out;
  forEachLine(lines, name, [&](const json& frame) {
    const double t = frame.at("timestamp").get<double>();
    for (const json& entry : frame.at("measurements")) out.push_back(sightingOf(entry, t));
  });
  std::stable_sort(out.begin(), out.end(), [](const auto& a, const auto& b) { return a.t < b.t; });
  return out;
}

FrameReports readBoxLines(std::istream& lines, const std::string& name) {
  FrameReports out;
  forEachLine(lines, name, [&](const json& frame) {
    auto report = std::make_shared<StepReport>();
    report->kind = StepReport::Kind::kFrame;
    report->t = frame.at("timestamp").get<double>();
    report->detections.fresh = true;
    for (const json& entry : frame.at("boxes")) report->detections.boxes.push_back(boxOf(entry));
    out.emplace_back(report->t, std::move(report));
  });
  std::stable_sort(out.begin(), out.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  return out;
}

std::map<LandmarkId, std::string> readViewLines(std::istream& lines, const std::string& name) {
  std::map<LandmarkId, std::string> out;
  forEachLine(lines, name, [&](const json& view) {
    out[LandmarkId{integerOf<std::int64_t>(view.at("id"))}] = fromBase64(view.at("jpeg").get<std::string>());
  });
  return out;
}

ShownLandmarks withCandidates(const ShownLandmarks& mapped, std::istream& in, const std::string& name) {
  const json content = wholeOf(in, name);
  ShownLandmarks out = mapped;
  std::size_t number = 0;
  try {
    for (const json& entry : content.at("landmarks")) {
      ++number;
      ShownLandmark shown{candidateOf(entry), false, {}};
      if (entry.contains("evidence")) entry.at("evidence").get_to(shown.evidence);
      const auto known = std::find_if(
          out.begin(), out.end(), [&](const auto& other) { return other->landmark.id == shown.landmark.id; });
      if (known != out.end()) {
        shown.landmark = (*known)->landmark;
        shown.in_map = (*known)->in_map;
        *known = std::make_shared<const ShownLandmark>(std::move(shown));
      } else {
        out.push_back(std::make_shared<const ShownLandmark>(std::move(shown)));
      }
    }
  } catch (const std::exception& error) {
    throw InputError(name + ": object " + std::to_string(number) + ": " + firstLine(error));
  }
  return out;
}

RunSummary readRunSummary(std::istream& in, const std::string& name) {
  const json summary = wholeOf(in, name);
  return {summary.value("input", ""), summary.value("counts", json::object()).value("loop_closures", std::size_t{0})};
}

}  // namespace roomgraph
