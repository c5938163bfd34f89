// SPDX-License-Identifier: BSD-3-Clause
// Dispatch of messages by topic, queueing, and completion of records by transforms and depth.
#include "conversion.h"

#include <algorithm>
#include <cstdio>

#include "image_decoding.h"
#include "record_making.h"
#include "roomgraph/datasets/import_images.h"
#include "roomgraph/observations/mrpt_camera.h"

namespace roomgraph::bags {
namespace {

constexpr double kKeepTransforms_s = 20;
constexpr std::int64_t kTrackDelay_ns = 200'000'000;  // other edges of the way may come a little later
constexpr std::int64_t kEndOfTime_ns = 7'258'118'400'000'000'000;  // 2200-01-01
constexpr float kMaxRangeM = 10;                                   // for viewers only

// Where the size was not known before, the first image that can be decoded tells it.
void requireSize(PinholeCamera& camera, cv::Size image) {
  if (camera.width == 0) {
    camera.width = image.width;
    camera.height = image.height;
  }
  if (image == cv::Size(camera.width, camera.height)) return;
  const auto text = [](int width, int height) {
    return std::to_string(width) + "x" + std::to_string(height);
  };
  throw BadMessage("image of " + text(image.width, image.height) + " px, the camera is of " +
                   text(camera.width, camera.height));
}

}  // namespace

Conversion::Conversion(Survey survey, const ImportPlan& plan, const BagImportOptions& options, Sink sink)
    : survey_(std::move(survey)),
      plan_(plan),
      options_(options),
      sink_(std::move(sink)),
      frames_(survey_.frames, plan.robot, plan.handheld),
      queue_(plan.window_s, options.max_time_difference_s),
      clock_(survey_.restarts, survey_.receptions) {
  for (std::size_t i = 0; i < survey_.topics.size(); ++i) topics_.emplace(survey_.topics[i].topic.name, i);
}

Want Conversion::wants(const BagTopic& topic) const {
  const auto found = topics_.find(topic.name);
  if (found == topics_.end()) return Want::kNothing;
  if (plan_.truth.topic == found->second) return Want::kAll;
  const std::string kind = kindOf(plan_.choice, survey_, found->second);
  const bool usable = (kind != "color" || plan_.color) && (kind != "depth" || plan_.depth);
  const bool needed = !kind.empty() && kind != "color_info" && kind != "depth_info" && usable;
  return needed ? Want::kAll : Want::kNothing;
}

void Conversion::take(const RawMessage& message, const BagTopic& topic) {
  const std::size_t index = topics_.at(topic.name);
  clock_.follow(index, message.received_ns);
  const auto& choice = plan_.choice;
  try {
    const TopicType type = survey_.topics[index].type;
    if (plan_.truth.topic == index) takeTruth(message, type);
    if (type == TopicType::kTransforms)
      takeTransforms(message, topic.name, isStaticTf(topic));
    else if (choice.color == index)
      takeColor(message, index);
    else if (choice.depth == index)
      takeDepth(message, index);
    else if (type == TopicType::kScan)
      takeScan(message, index);
    else if (choice.odometry == index)
      takeOdometry(message, index);
    else if (type == TopicType::kImu)
      takeImu(message, index);
  } catch (const BadMessage& error) {
    ++skipped_[topic.name + ": " + error.what()];
  }
  sampleTracks(false);
  release(false);
}

void Conversion::finish() {
  sampleTracks(true);
  release(true);
  queue_.clear();
  if (const int count = queue_.unpairedDepth(); count > 0)
    skipped_[survey_.topics[*plan_.choice.depth].topic.name + ": no colour image of its time"] += count;
}

void Conversion::takeTransforms(const RawMessage& message, const std::string& topic, bool is_static) {
  auto decoded = decode<TransformsMessage>(message);
  for (const auto& fault : decoded.faults) ++skipped_[topic + ": " + fault];
  for (auto& transform : decoded.transforms) {
    auto& t = transform.header.stamp_ns;
    const auto part = clock_.partOf(streamOf(transform), t);
    t += clock_.addedNs(part);
    const auto edge = survey_.frames.follow(transform, is_static, kKeepTransforms_s);
    if (!edge) continue;
    newest_tf_ns_ = std::max(newest_tf_ns_, t);
    if (plan_.truth.track && plan_.truth.track->edge == *edge) truth_times_.push_back({t, part});
    if (plan_.odometry && plan_.odometry->edge == *edge) odometry_times_.push_back({t, part});
  }
}

std::int64_t Conversion::timeOf(const MessageHeader& header, const RawMessage& message,
                                std::size_t topic) const {
  const bool received = options_.times == BagTimes::kReceived || header.stamp_ns == 0;
  const auto shift = plan_.shifts_ns.find(topic);
  const auto t =
      received ? message.received_ns : header.stamp_ns + (shift == plan_.shifts_ns.end() ? 0 : shift->second);
  if (t < 0 || t >= kEndOfTime_ns) throw BadMessage("time is not between 1970 and 2200");
  return t;
}

WaitingRecord Conversion::waiting(const MessageHeader& header, const RawMessage& message, std::size_t topic) {
  WaitingRecord record;
  const auto written_ns = timeOf(header, message, topic);
  const auto stamp_ns = header.stamp_ns == 0 ? message.received_ns : header.stamp_ns;
  const auto part = clock_.partOf(survey_.topics[topic].topic.name, stamp_ns);
  record.header_ns = stamp_ns + clock_.addedNs(part);
  // What has the time of reception is in order by that alone.
  const bool stamped = options_.times != BagTimes::kReceived && header.stamp_ns != 0;
  record.later_ns =
      stamped ? clock_.apartNs(part)
              : clock_.receivedNs() - message.received_ns + clock_.apartNs(part) - clock_.addedNs(part);
  record.t_ns = written_ns + record.later_ns;
  record.received_ns = clock_.receivedNs();
  record.frame = header.frame;
  return record;
}

void Conversion::takeColor(const RawMessage& message, std::size_t topic) {
  const bool compressed = survey_.topics[topic].type == TopicType::kCompressedImage;
  const auto image = imageOf(message, compressed);
  const cv::Mat decoded = colorImageOf(image, compressed);
  requireSize(plan_.color->camera, decoded.size());
  const cv::Mat pixels = plan_.color->rectified(decoded, false);
  auto record = waiting(image.header, message, topic);
  auto images = mrpt::obs::CObservation3DRangeScan::Create();
  images->hasIntensityImage = true;
  images->intensityImage = mrpt::img::CImage(pixels, mrpt::img::SHALLOW_COPY);
  record.is_color = plan_.depth.has_value();
  if (options_.external_images && compressed && pixels.data == decoded.data)
    record.picture.assign(image.data.begin(), image.data.end());
  record.bytes = pixels.total() * pixels.elemSize() + record.picture.size();
  record.observation = images;
  images->sensorLabel = plan_.labels.at(topic);
  queue_.push(std::move(record));
}

void Conversion::takeDepth(const RawMessage& message, std::size_t topic) {
  const bool compressed = survey_.topics[topic].type == TopicType::kCompressedImage;
  const auto image = imageOf(message, compressed);
  const cv::Mat decoded = depthImageOf(image, compressed);
  requireSize(plan_.depth->camera, decoded.size());
  const cv::Mat depth = plan_.depth->rectified(decoded, true);
  auto record = waiting(image.header, message, topic);
  if (plan_.color) {
    queue_.pushDepth(record.t_ns, record.received_ns, depth);
    return;
  }
  auto images = mrpt::obs::CObservation3DRangeScan::Create();
  setDepth(*images, depth);
  const auto label = plan_.labels.find(topic);  // the colour topic's, whose images cannot be used
  images->sensorLabel = label != plan_.labels.end() ? label->second : labelOfFrame(image.header.frame);
  record.observation = images;
  record.bytes = depth.total() * depth.elemSize();
  queue_.push(std::move(record));
}

void Conversion::takeScan(const RawMessage& message, std::size_t topic) {
  const auto scan = decode<LaserScanMessage>(message);
  auto record = waiting(scan.header, message, topic);
  record.observation = makeScan(scan, record.yaw);
  record.observation->sensorLabel = plan_.labels.at(topic);
  // Until something takes beams one by one, the middle of the sweep is the instant that errs least.
  record.t_ns += halfSweepNs(scan);
  record.header_ns += halfSweepNs(scan);
  queue_.push(std::move(record));
}

void Conversion::takeOdometry(const RawMessage& message, std::size_t topic) {
  const auto odometry = decode<OdometryMessage>(message);
  auto record = waiting(odometry.header, message, topic);
  record.observation = makeOdometry(odometry);
  record.observation->sensorLabel = plan_.labels.at(topic);
  record.placed = plan_.odometry_frame.empty();
  if (!record.placed) record.odometry = odometry;
  queue_.push(std::move(record));
}

void Conversion::takeImu(const RawMessage& message, std::size_t topic) {
  const auto imu = decode<ImuMessage>(message);
  auto record = waiting(imu.header, message, topic);
  record.observation = makeImu(imu);
  record.observation->sensorLabel = plan_.labels.at(topic);
  queue_.push(std::move(record));
}

void Conversion::takeTruth(const RawMessage& message, TopicType type) {
  PoseMessage pose;
  if (type == TopicType::kOdometry) {
    const auto odometry = decode<OdometryMessage>(message);
    pose = {odometry.header, odometry.pose};
  } else {
    pose = decode<PoseMessage>(message);
  }
  const auto t = timeOf(pose.header, message, *plan_.truth.topic);
  const auto stamp = pose.header.stamp_ns == 0 ? message.received_ns : pose.header.stamp_ns;
  const auto part = clock_.partOf(survey_.topics[*plan_.truth.topic].topic.name, stamp);
  if (plan_.truth.frame.empty() || part > 0)
    addTruth({t, part}, pose.pose);
  else
    truth_waiting_.push_back({{t, part}, pose.pose});
}

void Conversion::addTruth(const TrackTime& t, const Pose3& pose) {
  if (t.part > 0) {  // its times stand for others before, too
    ++skipped_["ground truth: behind the place where the clocks are set back"];
    return;
  }
  if (t.t_ns <= last_truth_ns_) {
    ++skipped_["ground truth: not in order of time"];
    return;
  }
  last_truth_ns_ = t.t_ns;
  const Eigen::Quaterniond q(pose.linear());
  const auto p = pose.translation();
  char line[256];
  std::snprintf(line, sizeof line, "%.9f %.9g %.9g %.9g %.9g %.9g %.9g %.9g\n",
                1e-9 * static_cast<double>(t.t_ns), p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), q.w());
  truth_ += line;
}

bool Conversion::isPast(std::int64_t t_ns, bool all) const {
  return all || t_ns + kTrackDelay_ns < newest_tf_ns_;
}

void Conversion::sample(const TfTrack& track, std::deque<TrackTime>& times, bool all,
                        const std::function<void(const TrackTime&, const Pose3&)>& use) {
  while (!times.empty() && isPast(times.front().t_ns, all)) {
    const auto t = times.front();
    times.pop_front();
    if (const auto pose = survey_.frames.at(track.way, t.t_ns)) use(t, *pose);
  }
}

void Conversion::sampleTracks(bool all) {
  turnTruth(all);
  if (plan_.truth.track)
    sample(*plan_.truth.track, truth_times_, all,
           [this](const TrackTime& t, const Pose3& pose) { addTruth(t, pose); });
  if (!plan_.odometry) return;
  sample(*plan_.odometry, odometry_times_, all, [this](const TrackTime& t, const Pose3& pose) {
    WaitingRecord record;
    record.observation = makeOdometry(pose);
    record.observation->sensorLabel = "ODOMETRY";
    record.header_ns = t.t_ns;
    record.later_ns = clock_.apartNs(t.part);
    record.t_ns = t.t_ns - clock_.addedNs(t.part) + record.later_ns;
    record.received_ns = clock_.receivedNs();
    record.placed = true;
    queue_.push(std::move(record));
  });
}

// Poses of a frame on the robot wait for the transforms of their times.
void Conversion::turnTruth(bool all) {
  while (!truth_waiting_.empty() && isPast(truth_waiting_.front().first.t_ns, all)) {
    const auto [t, pose] = truth_waiting_.front();
    truth_waiting_.pop_front();
    const auto& body = plan_.robot.empty() ? plan_.handheld : plan_.robot;
    const auto way = survey_.frames.way(plan_.truth.frame, body);
    if (const auto frame_from_body = survey_.frames.at(*way, t.t_ns))
      addTruth(t, normalized(pose * *frame_from_body));
    else
      ++skipped_["ground truth: no transform from '" + body + "' to '" + plan_.truth.frame + "' at its time"];
  }
}

void Conversion::release(bool all) {
  while (auto record = queue_.pop(all)) {
    const std::string label = record->observation->sensorLabel;
    const auto problem = complete(*record);
    if (!problem.empty()) {
      ++skipped_[label + ": " + problem];
      continue;
    }
    record->observation->timestamp = toMrptTime(record->t_ns - record->later_ns);
    sink_(*record->observation, record->picture);
    ++written_[label];
  }
}

std::string Conversion::complete(WaitingRecord& record) {
  if (record.placed) return "";
  if (std::dynamic_pointer_cast<mrpt::obs::CObservation3DRangeScan>(record.observation))
    return completeImages(record);
  return record.odometry ? completeOdometry(record) : place(record);
}

std::string Conversion::completeOdometry(WaitingRecord& record) {
  const auto robot_from_frame = frames_.at(plan_.odometry_frame, record.header_ns);
  if (!robot_from_frame) return robot_from_frame.reason();
  const auto label = record.observation->sensorLabel;
  record.observation = makeOdometry(movedTo(*record.odometry, robot_from_frame->inverse()));
  record.observation->sensorLabel = label;
  return "";
}

std::string Conversion::place(WaitingRecord& record) {
  const auto given = options_.sensor_poses.find(record.observation->sensorLabel);
  if (given != options_.sensor_poses.end()) {
    record.observation->setSensorPose(toMrpt(given->second));
    return "";
  }
  const auto robot_from_frame = frames_.at(record.frame, record.header_ns);
  if (!robot_from_frame) return robot_from_frame.reason();
  Pose3 frame_from_record = Pose3::Identity();
  frame_from_record.linear() = Eigen::AngleAxisd(record.yaw, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  record.observation->setSensorPose(toMrpt(*robot_from_frame * frame_from_record));
  return "";
}

std::string Conversion::completeImages(WaitingRecord& record) {
  auto& images = dynamic_cast<mrpt::obs::CObservation3DRangeScan&>(*record.observation);
  if (record.is_color) {
    const cv::Mat depth = queue_.takeDepth(record.t_ns);
    if (depth.empty()) return "no depth image of its time";
    setDepth(images, depth);
  }
  if (plan_.color) images.cameraParamsIntensity = toMrpt(plan_.color->camera);
  images.cameraParams = toMrpt(plan_.depth ? plan_.depth->camera : plan_.color->camera);
  images.maxRange = kMaxRangeM;
  Pose3 forward_from_optical = Pose3::Identity();
  forward_from_optical.linear() = bodyFromOptical();
  const std::string depth_frame = images.hasRangeImage ? plan_.depth_frame : record.frame;
  const auto robot_from_depth = frames_.opticalAt(depth_frame, record.header_ns);
  if (!robot_from_depth) return robot_from_depth.reason();
  const auto given = options_.sensor_poses.find(images.sensorLabel);
  images.setSensorPose(toMrpt(given != options_.sensor_poses.end()
                                  ? given->second
                                  : *robot_from_depth * forward_from_optical.inverse()));
  if (!images.hasIntensityImage || depth_frame == record.frame) return "";
  const auto robot_from_color = frames_.opticalAt(record.frame, record.header_ns);
  if (!robot_from_color) return robot_from_color.reason();
  const Pose3 depth_from_color = robot_from_depth->inverse() * *robot_from_color;
  const bool apart = depth_from_color.translation().norm() > 1e-6 || rotationAngle(depth_from_color) > 1e-6;
  if (apart)
    images.relativePoseIntensityWRTDepth = toMrpt(normalized(forward_from_optical * depth_from_color));
  return "";
}

}  // namespace roomgraph::bags
