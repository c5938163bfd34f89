// SPDX-License-Identifier: BSD-3-Clause
// Words of a line in the order that the header of CARMEN's logs gives for each message.
#include "carmen_line.h"

#include <charconv>
#include <cmath>
#include <stdexcept>

namespace roomgraph::carmen {
namespace {

constexpr std::size_t kMostReadings = 100'000;

struct BadLine : std::runtime_error {
  using std::runtime_error::runtime_error;
};

class Words {
 public:
  explicit Words(std::string_view line) : rest_(line) {}

  /// Empty at the end.
  std::string_view next() {
    const auto begin = rest_.find_first_not_of(" \t\r\n");
    if (begin == rest_.npos) return rest_ = {};
    const auto end = std::min(rest_.find_first_of(" \t\r\n", begin), rest_.size());
    const auto word = rest_.substr(begin, end - begin);
    rest_.remove_prefix(end);
    return word;
  }
  /// Also one that is not finite.
  double anyNumber(const char* what) {
    const auto word = next();
    if (word.empty()) throw BadLine(std::string("ends before ") + what);
    double value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc() || end != word.data() + word.size())
      throw BadLine(std::string(what) + " is no number");
    return value;
  }
  double number(const char* what) {
    const double value = anyNumber(what);
    if (!std::isfinite(value)) throw BadLine(std::string(what) + " is not finite");
    return value;
  }
  std::size_t count(const char* what) {
    const double value = number(what);
    if (value < 0 || value > kMostReadings || value != std::floor(value))
      throw BadLine(std::string(what) + " is no count");
    return static_cast<std::size_t>(value);
  }
  Pose2 pose(const char* what) {
    Pose2 pose;
    pose.x = number(what);
    pose.y = number(what);
    pose.yaw = wrapAngle(number(what));
    return pose;
  }
  std::vector<float> list(std::size_t size, const char* what) {
    std::vector<float> values;
    values.reserve(std::min(size, rest_.size()));
    for (std::size_t i = 0; i < size; ++i) values.push_back(static_cast<float>(anyNumber(what)));
    return values;
  }
  std::string_view rest() {
    const auto begin = rest_.find_first_not_of(" \t\r\n");
    if (begin == rest_.npos) return {};
    return rest_.substr(begin, rest_.find_last_not_of(" \t\r\n") + 1 - begin);
  }

 private:
  std::string_view rest_;
};

Stamps stampsOf(Words& words) {
  Stamps stamps{words.number("the time stamp"), std::nullopt};
  if (words.next().empty() || words.rest().empty()) return stamps;  // the host's name
  stamps.logger = words.number("the logger's time stamp");
  return stamps;
}

Sweep::Angles anglesOf(Words& words) {
  words.number("laser_type");
  Sweep::Angles angles;
  angles.start = words.number("start_angle");
  angles.field_of_view = words.number("field_of_view");
  angles.step = words.number("angular_resolution");
  angles.max_range_m = words.number("maximum_range");
  words.number("accuracy");
  words.number("remission_mode");
  return angles;
}

Sweep sweepOf(Words& words, bool has_angles, bool has_poses) {
  Sweep sweep;
  if (has_angles) sweep.angles = anglesOf(words);
  const auto readings = words.count("num_readings");
  if (readings == 0) throw BadLine("has no readings");
  sweep.ranges = words.list(readings, "the last reading");
  if (has_angles) {
    const auto remissions = words.count("num_remissions");
    sweep.remissions = words.list(remissions, "the last remission");
    if (remissions != readings) sweep.remissions.clear();
  }
  if (!has_poses) return sweep;
  sweep.laser = words.pose("the laser's pose");
  sweep.robot = words.pose("the robot's pose");
  if (has_angles)
    for (const char* what : {"laser_tv", "laser_rv", "forward_safety_dist", "side_safety_dist", "turn_axis"})
      words.number(what);
  return sweep;
}

Odometry odometryOf(Words& words) {
  Odometry odometry{words.pose("the pose")};
  odometry.forward_m_s = words.number("tv");
  odometry.turn_rad_s = words.number("rv");
  words.number("accel");
  return odometry;
}

// ROBOTLASER, ROBOTLASER1…
bool isNumbered(std::string_view name, std::string_view stem) {
  return name.starts_with(stem) &&
         name.substr(stem.size()).find_first_not_of("0123456789") == std::string_view::npos;
}

Message messageOf(Words& words) {
  const auto name = words.next();
  Message message{std::string(name), {}, {}};
  if (name.empty() || name[0] == '#') return {};
  if (name == "PARAM") {
    const auto parameter = words.next();
    message.content = Parameter{std::string(parameter), std::string(words.rest())};
    return message;
  }
  if (name == "ODOM") {
    message.content = odometryOf(words);
  } else if (name == "TRUEPOS") {
    message.content = TruePose{words.pose("the true pose")};
    words.pose("the odometry's pose");
  } else if (name == "FLASER" || name == "RLASER") {
    message.content = sweepOf(words, false, true);
  } else if (isNumbered(name, "ROBOTLASER")) {
    message.content = sweepOf(words, true, true);
  } else if (isNumbered(name, "RAWLASER")) {
    message.content = sweepOf(words, true, false);
  } else {
    return message;
  }
  message.stamps = stampsOf(words);
  return message;
}

}  // namespace

Outcome<Message> parseLine(std::string_view line) {
  Words words(line);
  try {
    return messageOf(words);
  } catch (const BadLine& error) {
    return Outcome<Message>::failure(error.what());
  }
}

}  // namespace roomgraph::carmen
