// SPDX-License-Identifier: BSD-3-Clause
// Values of faults as users write them.
#pragma once

#include <string>
#include <vector>

#include "fault.h"
#include "roomgraph/geometry/pose.h"

namespace roomgraph {

/// The value of one fault being read. Every function throws ConfigError that begins with the fault and ends
/// with the pattern that was expected.
class FaultText {
 public:
  FaultText(std::string kind, std::string value, std::string pattern)
      : kind_(std::move(kind)), value_(std::move(value)), pattern_(std::move(pattern)) {}

  /// "--drop-camera 10:20".
  std::string name() const { return "--" + kind_ + " " + value_; }
  /// Takes "camera=" from the front; `usual` when no sensor is named.
  StruckSensors takeSensors(const StruckSensors& usual);
  /// The same where one must be named.
  FaultySensor takeSensor();
  /// Takes "@A:B" from the end; the whole recording when there is none.
  FaultWindow takeWindowAtEnd();
  /// "A:B", "A:" or ":B".
  FaultWindow window() const;
  /// "A:B" as a window, or "A:B:C" with the number C; `usual` is C when there is none. C is above 0 and at most `most`.
  std::pair<FaultWindow, double> windowAndNumber(double usual, double most = 1e6) const;
  /// "A:SECONDS".
  std::pair<double, double> timeAndShift() const;
  /// "A".
  double time() const;
  /// "x,y,z,yaw,pitch,roll" in m and degrees.
  Pose3 pose() const;

 private:
  [[noreturn]] void refuse(const std::string& why) const;
  double number(const std::string& text) const;
  FaultWindow windowOf(const std::string& from, const std::string& to) const;

  std::string kind_, value_, pattern_;
  std::string rest_ = value_;  ///< what was not taken yet
};

}  // namespace roomgraph
