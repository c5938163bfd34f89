// SPDX-License-Identifier: BSD-3-Clause
// First reading of a bag: topics, first messages, clocks, frames.
#pragma once

#include <functional>
#include <optional>

#include "bag_reader.h"
#include "clock_watch.h"
#include "frame_graph.h"

namespace roomgraph::bags {

enum class TopicType {
  kImage,
  kCompressedImage,
  kCameraInfo,
  kScan,
  kOdometry,
  kPose,
  kImu,
  kTransforms,
  kOther
};
TopicType typeOf(const BagTopic& topic);
bool isStaticTf(const BagTopic& topic);

/// Differences of two clocks: at most kMost of them, evenly spread over all.
class ClockDelays {
 public:
  void add(double seconds);
  /// Of the whole, its first and its last quarter, s.
  struct Summary {
    double median = 0, first = 0, last = 0;
  };
  std::optional<Summary> summary() const;

 private:
  static constexpr std::size_t kMost = 4096;
  std::vector<double> kept_;
  std::uint64_t seen_ = 0, every_ = 1;
};

struct SurveyedTopic {
  BagTopic topic;
  TopicType type = TopicType::kOther;
  std::uint64_t count = 0, broken = 0, unstamped = 0;
  bool looked_at = false;                  ///< there was a message that is not broken: what follows is of it
  std::int64_t first_ns = 0, last_ns = 0;  ///< received
  std::string frame, child_frame;          ///< of the first message
  ImageHead image;                         ///< of the first image
  std::optional<CameraInfoMessage> info;   ///< the first that is calibrated, else the first
  ClockDelays header_minus_received;
  std::string fault;  ///< of the first broken message
};

struct Survey {
  std::vector<SurveyedTopic> topics;
  FrameGraph frames;
  std::vector<std::string> problems;     ///< of the bag itself
  std::vector<ClockRestart> restarts;    ///< of the clocks that stamp sensors
  std::vector<ClockRestart> receptions;  ///< of the recorder's clock
};

/// Reads the bag once, of images only their beginnings. `progress` as for importBag().
Survey surveyBag(const std::filesystem::path& bag, const std::function<void(double)>& progress);

/// Sizes of compressed images, whose messages do not tell them: those of the first picture of each topic that
/// can be decoded.
void lookAtPictures(const std::filesystem::path& bag, Survey& survey);

}  // namespace roomgraph::bags
