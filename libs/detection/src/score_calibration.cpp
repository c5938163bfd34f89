// SPDX-License-Identifier: BSD-3-Clause
// Reading of score calibrations, logits there and back.
#include "score_calibration.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "roomgraph/core/errors.h"
#include "roomgraph/core/text_file.h"
#include "roomgraph/detection/detection_record.h"

namespace roomgraph {
namespace {

constexpr double kLeast = 1e-9;  // away from 0 and 1, where logits have no end

double logit(double p) {
  p = std::clamp(p, kLeast, 1 - kLeast);
  return std::log(p / (1 - p));
}

double logistic(double x) {
  return 1 / (1 + std::exp(-x));
}

}  // namespace

ScoreCalibration ScoreCalibration::beside(const std::string& network) {
  ScoreCalibration out;
  const auto file = std::filesystem::path(network).replace_extension(".scores.json").string();
  if (!std::filesystem::is_regular_file(file)) return out;
  const auto json = parseJson<nlohmann::json>(readTextFile(file), file);
  constexpr double kMost = 1e3;
  try {
    for (const auto& [name, line] : json.at("classes").items()) {
      const Line read{line.at("slope").get<double>(), line.at("shift").get<double>()};
      if (!(read.slope > 0 && read.slope < kMost && std::abs(read.shift) < kMost))
        throw std::invalid_argument("class " + name + ": slope is to be in (0, 1000), shift in (-1000, 1000)");
      out.lines_[name] = read;
    }
  } catch (const std::exception& error) {
    throw InputError(file + ": no calibration of scores: " + error.what());
  }
  out.hash_ = fileHash(file);
  return out;
}

double ScoreCalibration::probability(const std::string& class_name, double score) const {
  const auto line = lines_.find(class_name);
  return line == lines_.end() ? score : logistic(line->second.slope * logit(score) + line->second.shift);
}

double ScoreCalibration::leastScore(double probability) const {
  double least = probability;
  for (const auto& [name, line] : lines_)
    least = std::min(least, logistic((logit(probability) - line.shift) / line.slope));
  return least;
}

}  // namespace roomgraph
