// SPDX-License-Identifier: BSD-3-Clause
// Relations, trajectories and boxes line by line.
#include "variant_truth.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <sstream>

#include "roomgraph/core/text_file.h"
#include "variant_records.h"

namespace roomgraph {
namespace {

using Json = nlohmann::ordered_json;

/// A line of a truth being rewritten.
struct TruthLine {
  const VariantTruth& truth;
  int number;
  std::string text;

  [[noreturn]] void refuse(const std::string& why) const {
    throw InputError(truth.input.string() + ":" + std::to_string(number) + ": " + why);
  }
  std::vector<double> numbers(std::size_t count) const {
    std::istringstream in(text);
    std::vector<double> out;
    for (std::string word; in >> word;) {
      std::size_t read = 0;
      try {
        out.push_back(std::stod(word, &read));
      } catch (const std::exception&) {
      }
      if (read != word.size()) refuse("'" + word + "' is not a number");
    }
    if (out.size() != count)
      refuse("has " + std::to_string(out.size()) + " numbers, expected " + std::to_string(count));
    return out;
  }
  void move(double& t, const VariantTime& time) const {
    if (!time.map(t)) refuse("no record has this time, and stamps are new");
  }
};

std::string joined(const std::vector<double>& numbers, std::size_t times) {
  std::string out;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    char text[40];
    std::snprintf(text, sizeof text, i < times ? "%.6f" : "%.9g", numbers[i]);
    out += (i ? " " : "") + std::string(text);
  }
  return out;
}

std::string relation(const TruthLine& line, const VariantTime& time, const VariantOptions& options) {
  auto values = line.numbers(8);
  line.move(values[0], time);
  line.move(values[1], time);
  if (options.mirrored)
    for (const std::size_t i : {3u, 5u, 7u}) values[i] = -values[i];  // y, roll and yaw
  return joined(values, 2);
}

std::string stampedPose(const TruthLine& line, const VariantTime& time, const VariantOptions& options) {
  auto values = line.numbers(8);
  line.move(values[0], time);
  if (options.mirrored) {
    const Pose3 pose = Eigen::Translation3d(values[1], values[2], values[3]) *
                       Eigen::Quaterniond(values[7], values[4], values[5], values[6]).normalized();
    const bool optical = line.truth.kind == VariantTruth::Kind::kCameraTrajectory;
    const Pose3 other = optical ? mirroredOptical(pose) : mirrored(pose);
    const Eigen::Quaterniond q(other.rotation());
    values = {values[0], other.translation().x(), other.translation().y(), other.translation().z(), q.x(), q.y(), q.z(), q.w()};
  }
  return joined(values, 1);
}

void mirrorBox(Json& object, const char* key, double width) {
  if (!object.contains(key)) return;
  auto& box = object.at(key);
  const double u_min = box.at(0).get<double>();
  box.at(0) = width - box.at(2).get<double>();
  box.at(2) = width - u_min;
}

std::string boxes(const TruthLine& line, const VariantTime& time, const VariantOptions& options,
                  std::uint32_t image_width) {
  if (options.mirrored && image_width == 0) line.refuse("boxes cannot be mirrored: the recording has no image");
  try {
    Json frame = Json::parse(line.text);
    Json& stamp = frame.at(frame.contains("t") ? "t" : "timestamp");
    double t = stamp.get<double>();
    line.move(t, time);
    stamp = std::round(1e6 * t) / 1e6;
    if (options.mirrored)
      for (auto& object : frame.at(frame.contains("objects") ? "objects" : "boxes"))
        for (const char* key : {"bbox", "full_bbox"}) mirrorBox(object, key, image_width);
    return frame.dump();
  } catch (const Json::exception& error) {
    line.refuse(jsonProblem(error, line.text));
  }
}

}  // namespace

bool VariantTime::map(double& t) const {
  constexpr double kSame_s = 1e-3;
  if (!moved_.empty()) {
    auto nearest = moved_.lower_bound(t);
    if (nearest == moved_.end() || (nearest != moved_.begin() && t - std::prev(nearest)->first < nearest->first - t))
      --nearest;
    if (std::abs(nearest->first - t) > kSame_s) return false;
    t = nearest->second;
  }
  if (backwards_) t = sum_ - t;
  return true;
}

std::string variantOfTruth(const VariantTruth& truth, const VariantTime& time, const VariantOptions& options,
                           std::uint32_t image_width) {
  std::istringstream in(readTextFile(truth.input));
  TruthLine line{truth, 0, {}};
  std::string comments;
  std::vector<std::string> lines;
  while (std::getline(in, line.text)) {
    ++line.number;
    if (line.text.find_first_not_of(" \t\r") == std::string::npos) continue;
    if (line.text.front() == '#')
      comments += line.text + "\n";
    else if (truth.kind == VariantTruth::Kind::kRelations)
      lines.push_back(relation(line, time, options));
    else if (truth.kind == VariantTruth::Kind::kBoxes)
      lines.push_back(boxes(line, time, options, image_width));
    else
      lines.push_back(stampedPose(line, time, options));
  }
  if (options.backwards) std::reverse(lines.begin(), lines.end());
  std::string out = comments;
  for (const auto& text : lines) out += text + "\n";
  return out;
}

}  // namespace roomgraph
