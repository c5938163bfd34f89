// SPDX-License-Identifier: BSD-3-Clause
// RawlogReader: stream of frames, scans, odometry and detections from a rawlog.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "roomgraph/datasets/calibration_file.h"
#include "roomgraph/datasets/clock_set_back.h"
#include "roomgraph/datasets/record_stream.h"
#include "roomgraph/datasets/sensor_poses.h"

namespace roomgraph {

/// A jump of the stamps of a sensor against those of the others, in the order of the file.
struct StampJump {
  double t = 0;        ///< s; stamp behind it, as it was read
  double seconds = 0;  ///< by how much, and what was left out there
};

/// By sensor label; "odometry" for whatever gives it.
using StampJumpsBySensor = std::map<std::string, std::vector<StampJump>>;

/// What was met on the way.
struct ReadStatistics {
  std::map<std::string, int> used;  ///< records per class
  std::map<std::string, int>
      skipped;          ///< records per reason: "CObservationIMU: not used", "image missing: …", …
  std::map<std::string, int> corrected{};  ///< records that ReadOptions::corrections changed, by what of them
  SensorPoses placed{};  ///< ReadOptions::sensor_poses: where the reader put sensors in place of what was recorded
  std::vector<ClockSetBack> clocks_set_back{};  ///< where ReadOptions::continue_time went on with the time before
  std::string warning;  ///< truncated file: reason with the byte offset; empty otherwise
  std::vector<std::string> sensor_warnings;  ///< several sensors of a kind, and none was asked for
};

/// Kinds of records wanted; what is not wanted is stepped over without being decoded, where that saves time.
/// Of each kind one sensor is used: the one whose sensorLabel is given here, or the first that appears.
struct ReadOptions {
  bool frames = true, scans = true, odometry = true;
  std::string rgbd_label{}, lidar_label{}, odometry_label{};
  SensorPoses sensor_poses{};  ///< instead of what the records say; labels that are not here keep theirs
  RecordCorrections corrections{};
  /// Where the clock of all sensors is set back, stamps go on as they were before: they differ from those recorded from there on.
  bool continue_time = false;
};

/// Streams a rawlog (observation-only or action/sensory-frame, plain or gzipped, images embedded or
/// external). Records that cannot be used are skipped and counted, never fatal.
class RawlogReader : public RecordStream {
 public:
  /// Opens the file. Throws InputError (missing, empty, not a rawlog) naming the file and the cause, or
  /// ConfigError when a label asked for does not occur in it.
  explicit RawlogReader(const std::filesystem::path& file, const ReadOptions& options = {});
  ~RawlogReader() override;
  RawlogReader(RawlogReader&&) noexcept;
  RawlogReader& operator=(RawlogReader&&) noexcept;

  /// The next usable record, in the order of the file; nothing at its end. A record with several observations (sensory
  /// frame) comes out one by one. Odometry of action records is summed up from the first one.
  std::optional<Record> next() override;
  /// Share of the file read, [0, 1].
  double progress() const override;
  const ReadStatistics& statistics() const;
  /// Of what was read; on any thread.
  StampJumpsBySensor stampJumps() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace roomgraph
