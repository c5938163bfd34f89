// SPDX-License-Identifier: BSD-3-Clause
// Parser of windows, sensors and numbers.
#include "fault_text.h"

#include <charconv>
#include <cmath>
#include <limits>
#include <sstream>

#include "roomgraph/core/errors.h"
#include "roomgraph/core/suggest.h"
#include "roomgraph/datasets/sensor_poses.h"

namespace roomgraph {
namespace {

const std::map<std::string, FaultySensor> kSensorNames{{"camera", FaultySensor::kCamera},
                                                       {"lidar", FaultySensor::kLidar},
                                                       {"odometry", FaultySensor::kOdometry}};

std::vector<std::string> splitAtColons(const std::string& text) {
  std::vector<std::string> parts;
  std::istringstream in(text);
  for (std::string part; std::getline(in, part, ':');) parts.push_back(part);
  if (!text.empty() && text.back() == ':') parts.emplace_back();
  return parts;
}

}  // namespace

void FaultText::refuse(const std::string& why) const {
  throw ConfigError(name() + ": " + why + "; expected " + pattern_);
}

double FaultText::number(const std::string& text) const {
  const char* begin = text.data() + (text.starts_with("+") ? 1 : 0);
  const char* end = text.data() + text.size();
  double value = 0;
  const auto [stopped, error] = std::from_chars(begin, end, value);
  if (error != std::errc{} || stopped != end || !std::isfinite(value))
    refuse("'" + text + "' is not a number");
  return value;
}

StruckSensors FaultText::takeSensors(const StruckSensors& usual) {
  const auto equals = rest_.find('=');
  if (equals == std::string::npos) return usual;
  const std::string wanted = rest_.substr(0, equals);
  rest_.erase(0, equals + 1);
  if (const auto found = kSensorNames.find(wanted); found != kSensorNames.end()) {
    if (!usual.contains(found->second)) refuse("this fault does not strike the " + wanted);
    return {found->second};
  }
  std::vector<std::string> known;
  for (const auto& [word, sensor] : kSensorNames) known.push_back(word);
  refuse("no sensor '" + wanted + "'" + didYouMean(wanted, known));
}

FaultySensor FaultText::takeSensor() {
  if (rest_.find('=') == std::string::npos) refuse("it names no sensor");
  return *takeSensors({FaultySensor::kCamera, FaultySensor::kLidar}).begin();
}

FaultWindow FaultText::windowOf(const std::string& from, const std::string& to) const {
  if (from.empty() && to.empty()) refuse("no time in it");
  const FaultWindow window{from.empty() ? 0 : number(from),
                           to.empty() ? std::numeric_limits<double>::infinity() : number(to)};
  if (window.from_s < 0) refuse("it begins before the recording");
  if (!(window.to_s > window.from_s)) refuse("it ends before it begins");
  return window;
}

FaultWindow FaultText::window() const {
  const auto parts = splitAtColons(rest_);
  if (parts.size() != 2) refuse("'" + rest_ + "' is not a span of time");
  return windowOf(parts[0], parts[1]);
}

FaultWindow FaultText::takeWindowAtEnd() {
  const auto at = rest_.find('@');
  if (at == std::string::npos) return {0, std::numeric_limits<double>::infinity()};
  const auto parts = splitAtColons(rest_.substr(at + 1));
  rest_.erase(at);
  if (parts.size() != 2) refuse("a span of time must stand behind '@'");
  return windowOf(parts[0], parts[1]);
}

std::pair<FaultWindow, double> FaultText::windowAndNumber(double usual, double most) const {
  const auto parts = splitAtColons(rest_);
  if (parts.size() != 2 && parts.size() != 3) refuse("'" + rest_ + "' is not a span of time");
  const double value = parts.size() == 3 ? number(parts[2]) : usual;
  if (!(value > 0)) refuse("the number behind the span must be above 0");
  if (value > most) refuse("the number behind the span must not be above " + std::to_string(std::lround(most)));
  return {windowOf(parts[0], parts[1]), value};
}

std::pair<double, double> FaultText::timeAndShift() const {
  const auto parts = splitAtColons(rest_);
  if (parts.size() != 2) refuse("'" + rest_ + "' is not a time and a shift");
  const std::pair<double, double> out{number(parts[0]), number(parts[1])};
  if (out.first < 0) refuse("it begins before the recording");
  if (out.second == 0) refuse("a shift of 0 s is no fault");
  if (std::abs(out.second) > 1e9) refuse("a shift of more than 30 years");
  return out;
}

double FaultText::time() const {
  const double t = number(rest_);
  if (t < 0) refuse("it begins before the recording");
  return t;
}

Pose3 FaultText::pose() const {
  Pose3 error = parsePose(rest_, name());
  if (error.isApprox(Pose3::Identity())) refuse("an error of 0 is no fault");
  return error;
}

}  // namespace roomgraph
