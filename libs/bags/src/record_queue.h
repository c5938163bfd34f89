// SPDX-License-Identifier: BSD-3-Clause
// RecordQueue: records of all sensors brought into order of time; pairing of colour with depth.
#pragma once

#include <mrpt/obs/CObservation.h>

#include <deque>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <opencv2/core/mat.hpp>

#include "messages.h"

namespace roomgraph::bags {

/// A record that waits for those before it, for its depth image and for the transforms of its time.
struct WaitingRecord {
  mrpt::obs::CObservation::Ptr observation;  ///< without pose
  std::int64_t t_ns = 0;                     ///< of the record, on a clock that is never set back
  std::int64_t header_ns = 0;                ///< in the clock of tf, as it is followed
  std::int64_t received_ns = 0;
  std::string frame;                        ///< of the sensor; empty with `placed`
  bool placed = false;                      ///< has no sensor pose to look up: odometry
  double yaw = 0;                           ///< of the record's x axis in the frame, rad
  std::vector<std::uint8_t> picture;        ///< JPEG or PNG of the colour image as the bag has it
  bool is_color = false;                    ///< waits for a depth image
  std::size_t bytes = 0;                    ///< that it holds
  std::int64_t later_ns = 0;                ///< by which t_ns is later than what is written
  std::optional<OdometryMessage> odometry;  ///< of another frame, to be turned into the robot's
};

/// Keeps what was received within the last seconds, so that records whose messages came a little late find
/// their places.
class RecordQueue {
 public:
  /// `pair_s`: largest time between colour and depth.
  RecordQueue(double window_s, double pair_s);

  void push(WaitingRecord record);
  void pushDepth(std::int64_t t_ns, std::int64_t received_ns, cv::Mat depth);
  /// The earliest record, when nothing earlier will come; `all`: at the end of the bag.
  std::optional<WaitingRecord> pop(bool all);
  /// The depth image that belongs to a colour image just popped; empty when there is none.
  cv::Mat takeDepth(std::int64_t t_ns);
  /// Depth images that found no colour image, so far or (after clear()) in all.
  int unpairedDepth() const { return unpaired_depth_; }
  void clear();

 private:
  struct WaitingDepth {
    std::int64_t received_ns = 0;
    cv::Mat image;
  };
  void noteReception(std::int64_t received_ns);
  void forgetDepths();

  std::int64_t window_ns_, pair_ns_, now_ns_ = 0;
  std::multimap<std::int64_t, WaitingRecord> records_;  ///< by time
  std::multimap<std::int64_t, WaitingDepth> depths_;    ///< by time
  std::size_t bytes_ = 0;
  int unpaired_depth_ = 0;
};

}  // namespace roomgraph::bags
