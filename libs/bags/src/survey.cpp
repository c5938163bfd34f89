// SPDX-License-Identifier: BSD-3-Clause
// Tally of each topic's messages, clocks and first contents.
#include "survey.h"

#include <algorithm>
#include <map>

#include "image_decoding.h"
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

/// The first reading: what is met, in the order of the bag.
class Surveyor {
 public:
  void take(const RawMessage& raw, const BagReader& reader) {
    while (survey_.topics.size() <= raw.topic) addTopic(reader.topics()[survey_.topics.size()]);
    auto& topic = survey_.topics[raw.topic];
    if (topic.count++ == 0) topic.first_ns = topic.last_ns = raw.received_ns;
    topic.first_ns = std::min(topic.first_ns, raw.received_ns);
    topic.last_ns = std::max(topic.last_ns, raw.received_ns);
    receptions_.take(topic.topic.name, raw.received_ns, true, counts_);
    if (topic.type != TopicType::kOther) {
      try {
        lookAt(topic, raw);
      } catch (const BadMessage& error) {
        if (topic.broken++ == 0) topic.fault = error.what();
      }
    }
    ++counts_[raw.topic];
  }
  Survey finished(const BagReader& reader) {
    stamps_.finish();
    receptions_.finish();
    survey_.problems = reader.problems();
    survey_.restarts = stamps_.restarts();
    survey_.receptions = receptions_.restarts();
    return std::move(survey_);
  }

 private:
  void addTopic(const BagTopic& added) {
    survey_.topics.emplace_back();
    survey_.topics.back().topic = added;
    survey_.topics.back().type = typeOf(added);
    counts_.push_back(0);
  }
  void lookAt(SurveyedTopic& topic, const RawMessage& raw) {
    if (topic.type == TopicType::kTransforms) return learn(topic, decode<TransformsMessage>(raw));
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
    stamps_.take(topic.topic.name, header.stamp_ns == 0 ? raw.received_ns : header.stamp_ns,
                 topic.type != TopicType::kPose, counts_);
  }
  void learn(const SurveyedTopic& topic, const TransformsMessage& message) {
    const bool is_static = isStaticTf(topic.topic);
    for (const auto& transform : message.transforms) {
      survey_.frames.learn(transform, is_static);
      if (!is_static) stamps_.take(streamOf(transform), transform.header.stamp_ns, false, counts_);
    }
    if (message.transforms.empty() && !message.faults.empty()) throw BadMessage(message.faults.front());
  }

  Survey survey_;
  ClockWatch stamps_, receptions_;
  std::vector<std::uint64_t> counts_;  ///< messages of each topic before the one that is looked at
};

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
  Surveyor surveyor;
  const auto reader = openBag(bag);
  reader->wants(wantOf);
  for (RawMessage raw; reader->next(raw);) {
    surveyor.take(raw, *reader);
    if (progress) progress(reader->progress());
  }
  return surveyor.finished(*reader);
}

void lookAtPictures(const std::filesystem::path& bag, Survey& survey) {
  constexpr int kTried = 10;  // of a topic; videos are in such messages, too
  std::map<std::string, std::pair<SurveyedTopic*, int>> open;
  for (auto& topic : survey.topics)
    if (topic.type == TopicType::kCompressedImage && topic.looked_at)
      open[topic.topic.name] = {&topic, kTried};
  if (open.empty()) return;
  const auto reader = openBag(bag);
  reader->wants(
      [&](const BagTopic& topic) { return open.contains(topic.name) ? Want::kAll : Want::kNothing; });
  for (RawMessage raw; !open.empty() && reader->next(raw);) {
    const auto found = open.find(reader->topics()[raw.topic].name);
    if (found == open.end()) continue;
    auto& [topic, left] = found->second;
    try {
      const auto image = imageOf(raw, true);
      const bool behind_header = image.encoding.find("compressedDepth") != std::string::npos;
      const cv::Mat pixels = behind_header ? depthImageOf(image, true) : colorImageOf(image, true);
      topic->image.width = static_cast<std::uint32_t>(pixels.cols);
      topic->image.height = static_cast<std::uint32_t>(pixels.rows);
      left = 0;
    } catch (const BadMessage&) {
      --left;
    }
    if (left == 0) open.erase(found);
  }
}

}  // namespace roomgraph::bags
