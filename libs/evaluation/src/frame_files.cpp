// SPDX-License-Identifier: BSD-3-Clause
// Parsers of boxes.jsonl, detections.jsonl and associations.jsonl.
#include "roomgraph/evaluation/frame_files.h"

#include <limits>
#include <stdexcept>

#include "json_lines.h"
#include "roomgraph/core/errors.h"
#include "roomgraph/core/json_integer.h"

namespace roomgraph {
namespace {

using nlohmann::json;

// Probability of the decision, which the posterior lists under the landmark's id or as "new".
double probabilityOf(const json& posterior, int landmark, bool is_new) {
  for (const auto& entry : posterior) {
    const json& name = entry.at("landmark");
    const bool chosen = is_new ? name == json("new") : name.is_number() && integerOf<int>(name) == landmark;
    if (chosen) return entry.at("p").get<double>();
  }
  return std::numeric_limits<double>::quiet_NaN();
}

AssociatedBox associatedFrom(const json& record) {
  AssociatedBox out;
  out.class_name = record.at("class").get<std::string>();
  out.box = boxFrom(record.at("bbox"));
  out.landmark = integerOf<int>(record.at("landmark"));
  out.is_new = record.at("new").get<bool>();
  out.probability = probabilityOf(record.value("posterior", json::array()), out.landmark, out.is_new);
  if (out.probability < 0 || out.probability > 1)
    throw std::invalid_argument("probability " + std::to_string(out.probability) + " is not in [0, 1]");
  return out;
}

}  // namespace

std::vector<TrueFrame> readTrueFrames(const std::filesystem::path& file) {
  std::vector<TrueFrame> frames;
  forEachJsonLine(file, [&](const json& line) {
    TrueFrame frame{line.at("t").get<double>(), {}};
    for (const auto& object : line.at("objects")) {
      const auto name = object.at("class").get<std::string>();
      frame.boxes.push_back({integerOf<int>(object.at("id")), name, object.value("kind", name),
                             boxFrom(object.at("bbox")), object.at("visible").get<double>()});
    }
    frames.push_back(std::move(frame));
  });
  if (frames.empty()) throw InputError(file.string() + ": is empty");
  return frames;
}

std::vector<DetectedFrame> readDetections(const std::filesystem::path& file) {
  std::vector<DetectedFrame> frames;
  forEachJsonLine(file, [&](const json& line) {
    DetectedFrame frame{line.at("timestamp").get<double>(), {}};
    for (const auto& box : line.at("boxes"))
      frame.boxes.push_back(
          {box.at("class").get<std::string>(), box.at("score").get<double>(), boxFrom(box.at("bbox"))});
    frames.push_back(std::move(frame));
  });
  return frames;
}

std::vector<AssociatedFrame> readAssociations(const std::filesystem::path& file) {
  std::vector<AssociatedFrame> frames;
  forEachJsonLine(file, [&](const json& line) {
    AssociatedFrame frame{line.at("timestamp").get<double>(), {}};
    for (const auto& record : line.at("measurements")) frame.boxes.push_back(associatedFrom(record));
    frames.push_back(std::move(frame));
  });
  return frames;
}

}  // namespace roomgraph
