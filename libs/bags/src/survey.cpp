// SPDX-License-Identifier: BSD-3-Clause
// Tally of each topic's messages, clocks and first contents.
#include "survey.h"

#include <algorithm>

#include "roomgraph/core/order_statistics.h"

namespace roomgraph::bags {
namespace {

void lookAtFirst(SurveyedTopic& topic, const RawMessage& raw) {
  if (topic.type == TopicType::kImage || topic.type == TopicType::kCompressedImage)
    topic.image = imageHeadOf(raw, topic.type == TopicType::kCompressedImage);
  else if (topic.type == TopicType::kOdometry)
    topic.child_frame = decode<OdometryMessage>(raw).child_frame;
}

void lookAtInfo(SurveyedTopic& topic, const RawMessage& raw) {
  const bool calibrated = topic.info && topic.info->k[0] > 0;
  if (calibrated) return;
  auto info = decode<CameraInfoMessage>(raw);
  if (!topic.info || info.k[0] > 0) topic.info = std::move(info);
}

void lookAt(SurveyedTopic& topic, const RawMessage& raw, FrameGraph& frames) {
  if (topic.type == TopicType::kTransforms) {
    for (const auto& transform : decode<TransformsMessage>(raw).transforms)
      frames.learn(transform, isStaticTf(topic.topic));
    return;
  }
  const auto header = headerOf(raw);
  if (!topic.looked_at) {
    topic.frame = header.frame;
    lookAtFirst(topic, raw);
    topic.looked_at = true;
  }
  if (topic.type == TopicType::kCameraInfo) lookAtInfo(topic, raw);
  if (header.stamp_ns == 0)
    ++topic.unstamped;
  else
    topic.header_minus_received.add(1e-9 * static_cast<double>(header.stamp_ns - raw.received_ns));
}

Want wantOf(const BagTopic& topic) {
  switch (typeOf(topic)) {
    case TopicType::kTransforms:
    case TopicType::kOdometry:
    case TopicType::kCameraInfo:
      return Want::kAll;
    default:
      return Want::kBeginning;  // others are counted
  }
}

}  // namespace

TopicType typeOf(const BagTopic& topic) {
  const auto& type = topic.type;
  if (type == "sensor_msgs/Image") return TopicType::kImage;
  if (type == "sensor_msgs/CompressedImage") return TopicType::kCompressedImage;
  if (type == "sensor_msgs/CameraInfo") return TopicType::kCameraInfo;
  if (type == "sensor_msgs/LaserScan") return TopicType::kScan;
  if (type == "nav_msgs/Odometry") return TopicType::kOdometry;
  if (type == "geometry_msgs/PoseStamped") return TopicType::kPose;
  if (type == "sensor_msgs/Imu") return TopicType::kImu;
  if (type == "tf2_msgs/TFMessage" || type == "tf/tfMessage") return TopicType::kTransforms;
  return TopicType::kOther;
}

bool isStaticTf(const BagTopic& topic) {
  return topic.name.ends_with("tf_static");
}

void ClockDelays::add(double seconds) {
  if (seen_++ % every_ != 0) return;
  kept_.push_back(seconds);
  if (kept_.size() < kMost) return;
  for (std::size_t i = 0; 2 * i < kept_.size(); ++i) kept_[i] = kept_[2 * i];
  kept_.resize(kMost / 2);
  every_ *= 2;
}

std::optional<ClockDelays::Summary> ClockDelays::summary() const {
  if (kept_.empty()) return std::nullopt;
  const auto quarter = static_cast<std::ptrdiff_t>(std::max<std::size_t>(1, kept_.size() / 4));
  return Summary{median(kept_), median({kept_.begin(), kept_.begin() + quarter}),
                 median({kept_.end() - quarter, kept_.end()})};
}

Survey surveyBag(const std::filesystem::path& bag, const std::function<void(double)>& progress) {
  Survey survey;
  const auto reader = openBag(bag);
  reader->wants(wantOf);
  for (RawMessage raw; reader->next(raw);) {
    while (survey.topics.size() <= raw.topic) {
      const BagTopic& added = reader->topics()[survey.topics.size()];
      survey.topics.emplace_back();
      survey.topics.back().topic = added;
      survey.topics.back().type = typeOf(added);
    }
    auto& topic = survey.topics[raw.topic];
    if (topic.count++ == 0) topic.first_ns = topic.last_ns = raw.received_ns;
    topic.first_ns = std::min(topic.first_ns, raw.received_ns);
    topic.last_ns = std::max(topic.last_ns, raw.received_ns);
    if (topic.type != TopicType::kOther) {
      try {
        lookAt(topic, raw, survey.frames);
      } catch (const BadMessage& error) {
        if (topic.broken++ == 0) topic.fault = error.what();
      }
    }
    if (progress) progress(reader->progress());
  }
  survey.problems = reader->problems();
  return survey;
}

}  // namespace roomgraph::bags
