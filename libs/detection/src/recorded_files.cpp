// SPDX-License-Identifier: BSD-3-Clause
// Reader of recorded boxes in JSON lines or text lines, with masks.
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <sstream>

#include "label_lists.h"
#include "recorded_detector.h"
#include "roomgraph/core/json_integer.h"
#include "roomgraph/core/text_file.h"
#include "roomgraph/observations/image_file.h"

namespace roomgraph {
namespace {

using Json = nlohmann::json;

double seconds(const Json& value) {
  const double t = value.is_string() ? std::stod(value.get<std::string>()) : value.get<double>();
  if (!std::isfinite(t)) throw std::invalid_argument("the time stamp is no number");
  return t;
}

bool sound(const Detection& d) {
  constexpr double kFarthest_px = 1e6;  // larger than any image; arithmetic with a box must not overflow
  const auto near = [](double side) { return std::abs(side) < kFarthest_px; };
  return near(d.box.u_min) && near(d.box.v_min) && near(d.box.u_max) && near(d.box.v_max) && !d.box.empty() &&
         d.score >= 0 && d.score <= 1;
}

// A mask over the whole image, cut to its box; the box is the mask's own.
void readMask(const std::filesystem::path& file, Detection& detection) {
  const cv::Mat mask = readImageFile(file, cv::IMREAD_GRAYSCALE);
  if (mask.empty()) throw std::invalid_argument("mask " + file.string() + " cannot be read");
  std::vector<cv::Point> inside;
  cv::findNonZero(mask, inside);
  if (inside.empty()) throw std::invalid_argument("mask " + file.string() + " is empty");
  const cv::Rect box = cv::boundingRect(inside);
  detection.box = {1.0 * box.x, 1.0 * box.y, 1.0 * box.x + box.width, 1.0 * box.y + box.height};
  detection.mask = mask(box) > 0;
}

void readRival(const Json& rival, Detection& detection) {
  detection.rival_label = rival.at("label").get<std::string>();
  detection.rival_score = rival.at("score").get<double>();
  if (!(detection.rival_score >= 0 && detection.rival_score <= 1))
    throw std::invalid_argument("score of a rival out of range");
}

// What was carried to a frame is carried to it again: a line of nothing else is no record of what a detector saw.
void addJsonLine(const Json& json, const std::filesystem::path& folder, DetectionRecords& records) {
  RecordedBoxes boxes;
  boxes.carried = json.value("carried", false);
  for (const Json& item : json.at("boxes")) {
    if (item.value("carried", false)) continue;
    Detection detection;
    detection.label = item.at("class").get<std::string>();
    detection.score = item.at("score").get<double>();
    if (item.contains("mask")) {
      readMask(folder / item.at("mask").get<std::string>(), detection);
    } else {
      const auto sides = item.at("bbox").get<std::array<double, 4>>();
      detection.box = {sides[0], sides[1], sides[2], sides[3]};
    }
    if (item.contains("track")) detection.track = TrackId{integerOf<std::int64_t>(item.at("track"))};
    if (!sound(detection)) throw std::invalid_argument("box or score out of range");
    if (item.contains("rival")) readRival(item.at("rival"), detection);
    boxes.boxes.push_back(detection);
  }
  if (json.contains("unsought")) boxes.unsought = json.at("unsought").get<std::vector<std::string>>();
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
  std::istringstream in(readTextFile(file));
  const auto folder = std::filesystem::path(file).parent_path();
  DetectionRecords records;
  int number = 0;
  for (std::string line; std::getline(in, line);) {
    ++number;
    const auto first = line.find_first_not_of(" \t\r");
    if (first == std::string::npos || line[first] == '#') continue;
    const std::string place = file + ":" + std::to_string(number) + ": not a record of detections";
    try {
      if (line[first] == '{')
        addJsonLine(parseJson<Json>(line, place), folder, records);
      else
        addTextLine(line, records);
    } catch (const InputError&) {
      throw;
    } catch (const std::exception& error) {
      throw InputError(place + ": " + firstLine(error));
    }
  }
  return records;
}

}  // namespace roomgraph
