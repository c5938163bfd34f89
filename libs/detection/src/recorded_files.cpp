// SPDX-License-Identifier: BSD-3-Clause
// Part of roomgraph, object-level semantic SLAM.
#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <sstream>

#include "roomgraph/core/errors.h"
#include "roomgraph/detection/decoders.h"
#include "roomgraph/detection/recorded_detector.h"

namespace roomgraph {
namespace {

using Json = nlohmann::json;

double seconds(const Json& value) {
  return value.is_string() ? std::stod(value.get<std::string>()) : value.get<double>();
}

bool sound(const Detection& d) {
  return std::isfinite(d.box.u_min) && std::isfinite(d.box.v_min) && std::isfinite(d.box.u_max) &&
         std::isfinite(d.box.v_max) && !d.box.empty() && d.score >= 0 && d.score <= 1;
}

// A mask over the whole image, cut to its box; the box is the mask's own.
void readMask(const std::filesystem::path& file, Detection& detection) {
  const cv::Mat mask = cv::imread(file.string(), cv::IMREAD_GRAYSCALE);
  if (mask.empty()) throw std::invalid_argument("mask " + file.string() + " cannot be read");
  std::vector<cv::Point> inside;
  cv::findNonZero(mask, inside);
  if (inside.empty()) throw std::invalid_argument("mask " + file.string() + " is empty");
  const cv::Rect box = cv::boundingRect(inside);
  detection.box = {1.0 * box.x, 1.0 * box.y, 1.0 * box.x + box.width, 1.0 * box.y + box.height};
  detection.mask = mask(box) > 0;
}

void addJsonLine(const std::string& line, const std::filesystem::path& folder, DetectionRecords& records) {
  const Json json = Json::parse(line);
  RecordedBoxes boxes;
  for (const Json& item : json.at("boxes")) {
    Detection detection;
    detection.label = item.at("class").get<std::string>();
    detection.score = item.at("score").get<double>();
    if (item.contains("mask")) {
      readMask(folder / item.at("mask").get<std::string>(), detection);
    } else {
      const auto sides = item.at("bbox").get<std::array<double, 4>>();
      detection.box = {sides[0], sides[1], sides[2], sides[3]};
    }
    if (item.contains("track")) detection.track = TrackId{item.at("track").get<std::int64_t>()};
    if (!sound(detection)) throw std::invalid_argument("box or score out of range");
    boxes.boxes.push_back(detection);
  }
  records.emplace(seconds(json.at("timestamp")), boxes);
}

// One line per box: lines of one time make one record.
void addTextLine(const std::string& line, DetectionRecords& records) {
  std::istringstream in(line);
  double t = 0, x = 0, y = 0, width = 0, height = 0;
  int coco = 0;
  Detection detection;
  if (!(in >> t >> coco >> x >> y >> width >> height >> detection.score))
    throw std::invalid_argument("expected: timestamp cocoID x y w h score");
  detection.label = cocoLabel(coco);
  detection.box = {x, y, x + width, y + height};
  if (!sound(detection)) throw std::invalid_argument("box or score out of range");
  auto record = records.find(t);
  if (record == records.end()) record = records.emplace(t, RecordedBoxes{});
  record->second.boxes.push_back(detection);
}

}  // namespace

DetectionRecords readDetectionFile(const std::string& file) {
  std::ifstream in(file);
  if (!in) throw InputError(file + ": cannot be read");
  const auto folder = std::filesystem::path(file).parent_path();
  DetectionRecords records;
  int number = 0;
  for (std::string line; std::getline(in, line);) {
    ++number;
    const auto first = line.find_first_not_of(" \t\r");
    if (first == std::string::npos || line[first] == '#') continue;
    try {
      line[first] == '{' ? addJsonLine(line, folder, records) : addTextLine(line, records);
    } catch (const std::exception& error) {
      throw InputError(file + ":" + std::to_string(number) + ": not a record of detections: " + error.what());
    }
  }
  return records;
}

}  // namespace roomgraph
