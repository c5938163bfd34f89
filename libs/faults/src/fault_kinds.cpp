// SPDX-License-Identifier: BSD-3-Clause
// Table of the kinds of faults: name, pattern of the value, words, maker.
#include "fault_kinds.h"

#include <algorithm>
#include <functional>
#include <limits>

#include "clock_jump.h"
#include "fault_text.h"
#include "image_faults.h"
#include "moving_furniture.h"
#include "pose_fault.h"
#include "record_faults.h"
#include "roomgraph/core/errors.h"
#include "roomgraph/core/suggest.h"
#include "value_faults.h"
#include "wheel_faults.h"

namespace roomgraph {
namespace {

using enum FaultySensor;
using Made = std::unique_ptr<Fault>;

struct KindEntry {
  FaultKind kind;
  std::function<Made(FaultText, const Random&)> make;
};

const StruckSensors kMeasuring{kCamera, kLidar, kOdometry};
const StruckSensors kAll{kCamera, kLidar, kOdometry, kOther};
constexpr double kForEver = std::numeric_limits<double>::infinity();

KindEntry dropOf(const std::string& name, FaultySensor sensor) {
  return {{"drop-" + name, "A:B", "the " + name + " gives nothing"},
          [=](const FaultText& text, const Random&) -> Made {
            return std::make_unique<DropFault>(StruckSensors{sensor}, text.window());
          }};
}

KindEntry freezeOf(const std::string& name, FaultySensor sensor) {
  return {{"freeze-" + name, "A:B", "the " + name + " repeats its last record with new stamps"},
          [=](const FaultText& text, const Random&) -> Made {
            return std::make_unique<FreezeFault>(sensor, text.window());
          }};
}

template <class WindowFault>
KindEntry inWindow(FaultKind kind) {
  return {std::move(kind), [](const FaultText& text, const Random&) -> Made {
            return std::make_unique<WindowFault>(text.window());
          }};
}

template <class RecordFault>
KindEntry ofRecords(FaultKind kind) {
  return {std::move(kind), [](FaultText text, const Random&) -> Made {
            StruckSensors sensors = text.takeSensors(kAll);
            return std::make_unique<RecordFault>(std::move(sensors), text.window());
          }};
}

KindEntry pictureOf(FaultKind kind, std::uint8_t level) {
  return {std::move(kind), [level](const FaultText& text, const Random&) -> Made {
            return std::make_unique<UniformPictureFault>(level, text.window());
          }};
}

Made makeUnplugged(const FaultText& text, const Random&) {
  return std::make_unique<DropFault>(StruckSensors{kOdometry}, FaultWindow{text.time(), kForEver});
}

Made makeClockJump(FaultText text, const Random&) {
  StruckSensors sensors = text.takeSensors(kAll);
  const auto [at_s, shift_s] = text.timeAndShift();
  return std::make_unique<ClockJumpFault>(std::move(sensors), at_s, shift_s);
}

Made makeNotANumber(FaultText text, const Random& random) {
  StruckSensors sensors = text.takeSensors(kMeasuring);
  return std::make_unique<NotANumberFault>(std::move(sensors), text.window(), random);
}

Made makeNoise(FaultText text, const Random& random) {
  StruckSensors sensors = text.takeSensors(kMeasuring);
  const auto [window, factor] = text.windowAndNumber(1);
  return std::make_unique<NoiseFault>(std::move(sensors), window, factor, random);
}

Made makeWrongExtrinsics(FaultText text, const Random&) {
  const FaultySensor sensor = text.takeSensor();
  const FaultWindow window = text.takeWindowAtEnd();
  return std::make_unique<WrongExtrinsicsFault>(sensor, text.pose(), window);
}

Made makeMovingFurniture(const FaultText& text, const Random&) {
  constexpr double kFastest_m_s = 10;
  const auto [window, speed_m_s] = text.windowAndNumber(0.25, kFastest_m_s);
  return std::make_unique<MovingFurnitureFault>(window, speed_m_s);
}

const std::vector<KindEntry>& kindTable() {
  static const std::vector<KindEntry> table{
      dropOf("camera", kCamera),
      dropOf("lidar", kLidar),
      dropOf("odometry", kOdometry),
      {{"unplug-odometry", "A", "no odometry from A to the end"}, makeUnplugged},
      freezeOf("camera", kCamera),
      freezeOf("lidar", kLidar),
      freezeOf("odometry", kOdometry),
      inWindow<LiftedWheelsFault>({"lift-wheels", "A:B", "odometry stands still, and goes on from there"}),
      inWindow<KidnapFault>(
          {"kidnap", "A:B", "the robot is carried off: no record of any sensor, wheels that do not turn"}),
      {{"clock-jump", "[SENSOR=]A:SECONDS", "stamps from A on are later, or with -SECONDS earlier"},
       makeClockJump},
      ofRecords<SwapFault>({"swap-order", "[SENSOR=]A:B", "neighbouring records change places in the file"}),
      ofRecords<DuplicateFault>({"duplicate", "[SENSOR=]A:B", "records come twice, with one stamp"}),
      {{"nan", "[SENSOR=]A:B", "NaN and infinity in scans, depth units and odometry"}, makeNotANumber},
      {{"noise", "[SENSOR=]A:B[:FACTOR]",
        "normal noise: scans 0.3 m, depth 0.1 m, pictures 40 grey levels, odometry 0.1 m and rad; times "
        "FACTOR"},
       makeNoise},
      pictureOf({"black", "A:B", "black pictures, in which no object was detected; depth stays"}, 0),
      pictureOf({"white", "A:B", "the same in white"}, 255),
      inWindow<NoDepthFault>({"no-depth", "A:B", "depth images without a valid pixel; colour stays"}),
      {{"wrong-extrinsics", "SENSOR=x,y,z,yaw,pitch,roll[@A:B]",
        "recorded pose of the camera or lidar off by so much (m, deg, along the robot's axes)"},
       makeWrongExtrinsics},
      {{"moving-furniture", "A:B[:SPEED]",
        "a cupboard is pushed to and fro before the robot, at SPEED (0.25 m/s); needs odometry"},
       makeMovingFurniture}};
  return table;
}

}  // namespace

const std::vector<FaultKind>& faultKinds() {
  static const std::vector<FaultKind> kinds = [] {
    std::vector<FaultKind> out;
    for (const auto& entry : kindTable()) out.push_back(entry.kind);
    return out;
  }();
  return kinds;
}

std::unique_ptr<Fault> makeFault(const FaultRequest& request, const Random& random) {
  const auto& table = kindTable();
  const auto entry = std::find_if(table.begin(), table.end(),
                                  [&](const KindEntry& known) { return known.kind.name == request.kind; });
  if (entry != table.end()) return entry->make({request.kind, request.value, entry->kind.value}, random);
  std::vector<std::string> names;
  for (const auto& known : table) names.push_back(known.kind.name);
  throw ConfigError("no fault '" + request.kind + "'" + didYouMean(request.kind, names) +
                    "; known: " + join(names));
}

}  // namespace roomgraph
