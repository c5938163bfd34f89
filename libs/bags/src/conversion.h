// SPDX-License-Identifier: BSD-3-Clause
// Conversion: messages of a bag in, observations in order of time and ground truth out.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "continued_clock.h"
#include "import_plan.h"
#include "record_queue.h"
#include "sensor_frames.h"

namespace roomgraph::bags {

/// Second reading of a bag. Owns everything that changes meanwhile: the queue, the recent transforms, the
/// tallies.
class Conversion {
 public:
  /// Gets a finished record, and its colour image as it was in the bag (perhaps empty).
  using Sink = std::function<void(mrpt::obs::CObservation&, const std::vector<std::uint8_t>& picture)>;

  Conversion(Survey survey, const ImportPlan& plan, const BagImportOptions& options, Sink sink);

  Want wants(const BagTopic& topic) const;
  /// A message of a topic of this name. What cannot be used is counted.
  void take(const RawMessage& message, const BagTopic& topic);
  void finish();

  const std::map<std::string, int>& written() const { return written_; }
  const std::map<std::string, int>& skipped() const { return skipped_; }
  /// Lines "t x y z qx qy qz qw" of the ground truth.
  const std::string& truth() const { return truth_; }
  std::vector<std::string> warnings() const { return frames_.warnings(); }

 private:
  void takeTransforms(const RawMessage& message, const std::string& topic, bool is_static);
  void takeColor(const RawMessage& message, std::size_t topic);
  void takeDepth(const RawMessage& message, std::size_t topic);
  void takeScan(const RawMessage& message, std::size_t topic);
  void takeOdometry(const RawMessage& message, std::size_t topic);
  void takeImu(const RawMessage& message, std::size_t topic);
  void takeTruth(const RawMessage& message, TopicType type);
  WaitingRecord waiting(const MessageHeader& header, const RawMessage& message, std::size_t topic);
  std::int64_t timeOf(const MessageHeader& header, const RawMessage& message, std::size_t topic) const;

  /// Time of a transform, on the clock that goes on.
  struct TrackTime {
    std::int64_t t_ns = 0;
    std::size_t part = 0;
  };
  void sample(const TfTrack& track, std::deque<TrackTime>& times, bool all,
              const std::function<void(const TrackTime&, const Pose3&)>& use);
  void sampleTracks(bool all);
  void turnTruth(bool all);
  bool isPast(std::int64_t t_ns, bool all) const;
  void release(bool all);
  /// Empty, or why the record cannot be written.
  std::string complete(WaitingRecord& record);
  std::string completeImages(WaitingRecord& record);
  std::string completeOdometry(WaitingRecord& record);
  std::string place(WaitingRecord& record);
  void addTruth(const TrackTime& t, const Pose3& pose);

  Survey survey_;
  ImportPlan plan_;
  BagImportOptions options_;
  Sink sink_;
  SensorFrames frames_;
  RecordQueue queue_;
  ContinuedClock clock_;
  std::map<std::string, std::size_t> topics_;  ///< index in the survey by name
  std::deque<TrackTime> truth_times_, odometry_times_;
  std::deque<std::pair<TrackTime, Pose3>> truth_waiting_;  ///< of another frame than the robot's
  std::int64_t newest_tf_ns_ = 0, last_truth_ns_ = 0;
  std::map<std::string, int> written_, skipped_;
  std::string truth_;
};

}  // namespace roomgraph::bags
