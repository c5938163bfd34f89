// SPDX-License-Identifier: BSD-3-Clause
// Report about a rawlog: sensors, cameras, scans, time stamps and findings with hints.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "roomgraph/datasets/clock_set_back.h"
#include "roomgraph/datasets/sensor_poses.h"
#include "roomgraph/geometry/camera.h"
#include "roomgraph/geometry/pose.h"
#include "roomgraph/observations/mrpt_camera.h"

namespace roomgraph {

enum class Severity { kNote, kWarning, kError };
const char* toString(Severity severity);

/// Something about a recording that will, or may, spoil what is computed from it.
struct Finding {
  Severity severity = Severity::kNote;
  std::string what;
  std::string place;  ///< sensor label, with record number or time where one record is to blame
  std::string hint;   ///< what to do about it
};

/// The floor as a robot's depth images see it, always at the same place.
struct FloorSummary {
  int images = 0;              ///< that show it
  double sensor_height_m = 0;  ///< above it
  double tilt_rad = 0;         ///< between its normal and the robot's up direction
  Pose3 fitting_pose =
      Pose3::Identity();  ///< robot_from_sensor that would put it at z = 0; x and y as recorded
};

/// By how much the floor is now here, now there in the images of a camera: median deviations.
struct FloorSpread {
  double height_m = 0, direction_rad = 0;
};

/// Stamps of a sensor minus those of a reference sensor between whose records its own stand in the file, s.
struct ClockOffset {
  double first_s = 0, last_s = 0;    ///< at the beginning and at the end
  double step_s = 0, step_time = 0;  ///< largest change from one record to the next; 0: none stands out
  std::string reference;             ///< label
};

/// Records in a row with the same content.
struct SameRecords {
  int records = 0;
  double from = 0, seconds = 0;  ///< s
};

/// Records that lack something.
struct PoorRecords {
  int count = 0;
  double first_time = 0;  ///< s
};

/// Camera of a sensor and what its images are like.
struct ImageSummary {
  int color = 0, depth = 0;    ///< records that have one
  PinholeCamera color_camera;  ///< of the first record, as calibrated; size of its image
  PinholeCamera depth_camera;
  int color_width = 0, color_height = 0, depth_width = 0, depth_height = 0;  ///< px
  bool registered = false;  ///< depth and colour have one camera in common
  bool range_is_depth = true;
  double depth_unit_m = 0;
  double median_depth_m = 0;                 ///< of the valid pixels looked at; 0 when there are none
  double near_depth_m = 0, far_depth_m = 0;  ///< 5 % of them are nearer, 5 % are further
  double valid_depth_share = 0;
  int external_present = 0, external_missing = 0;  ///< records with images in files outside the rawlog
  std::string first_missing;                       ///< file
  int looked_at = 0;                  ///< images behind these: all, or every tenth where they are in files
  PoorRecords blank;                  ///< pictures without any structure
  PoorRecords noisy;                  ///< depth images much rougher than the others
  PoorRecords without_depth;          ///< depth images without a valid pixel
  SameRecords same;                   ///< colour and depth
  std::optional<FloorSummary> floor;  ///< nothing when it is not seen, or not always at one place
  std::optional<FloorSpread> floor_spread;  ///< when it is seen, and not at one place
  std::optional<double> walls_off_m;  ///< median distance of surfaces at the lidar's height from its own
  std::optional<double> range_over_lidar;  ///< how far depth sees along horizontal rays, over the lidar
  Distortion color_distortion, depth_distortion;  ///< of the first record; the cameras have the five of plumb_bob only
};

struct ScanSummary {
  int beams = 0;  ///< of the first scan
  bool beams_change = false;
  double aperture_rad = 0;
  double max_range_m = 0;
  bool right_to_left = true;
  bool upside_down = false;  ///< by its pose on the robot
  double valid_share = 0;      ///< returns among all beams
  double at_max_share = 0;     ///< beams at the maximum range among all
  std::size_t not_finite = 0;  ///< ranges that are marked valid and are NaN or infinite
  PoorRecords noisy;           ///< scans much rougher than the others
  SameRecords same;
  double largest_change_m = 0;  ///< mean difference per beam of a scan to the first one, largest
  /// Rotation by odometry over that seen in the scans, in turns on the spot (1 when all is well, negative
  /// when the scans are mirrored); nothing when there are too few such turns, or a quarter of them say that all is well and the median not.
  std::optional<double> rotation_ratio;
};

/// A time at which odometry does not change at all.
struct OdometryStandstill {
  double from = 0, seconds = 0;  ///< s
  double scan_change_m = 0;  ///< mean difference per beam of the scans at its end to those at its beginning
};

struct OdometrySummary {
  double path_length_m = 0;
  double turn_rad = 0;  ///< sum of the turns, without sign
  int jumps = 0;        ///< steps that no robot in a room can do
  double first_jump_time = 0, largest_jump_m = 0, largest_jump_rad = 0;
  std::optional<OdometryStandstill> standstill;  ///< that in which the scans change most
};

struct SensorReport {
  std::string label, class_name;
  bool used = false;  ///< a kind of record that roomgraph uses
  int count = 0;
  int invalid_times = 0;
  int out_of_order = 0;                  ///< records older than the one before them of the same sensor
  int first_out_of_order = -1;           ///< number of the record among the sensor's own
  int repeated_stamps = 0;               ///< records with the stamp of the one before
  double first_time = 0, last_time = 0;  ///< s
  double rate_hz = 0;
  double median_interval_s = 0;
  double largest_gap_s = 0, largest_gap_time = 0;
  std::optional<ClockOffset> clock_offset;  ///< nothing for the reference, and when records do not alternate
  std::optional<Pose3> robot_from_sensor;   ///< MRPT's sensorPose of the first record (x forward)
  bool pose_changes = false;
  std::optional<ImageSummary> images;
  std::optional<ScanSummary> scans;
  std::optional<OdometrySummary> odometry;
};

struct RawlogReport {
  std::filesystem::path file;
  std::uint64_t file_bytes = 0;
  std::string format;                    ///< "observations", "actions and sensory frames" or "mixed"
  int records = 0;                       ///< top-level objects
  double first_time = 0, last_time = 0;  ///< s, of all sensors
  std::vector<ClockSetBack> clocks_set_back;  ///< times are counted on from there
  double largest_step_back_s = 0;        ///< how far a record is older than one before it in the file
  std::vector<SensorReport> sensors;     ///< in the order they first appear
  std::map<std::string, int> skipped;    ///< broken records by reason
  std::string truncation;                ///< file ends too early: where; empty otherwise
  std::vector<Finding> findings;         ///< worst first

  double duration() const { return last_time - first_time; }
};

/// Reads the file, all of it or its first `until_s` seconds (by every sensor's own clock; 0: all), and says what is inside and what is wrong with it. Throws InputError like
/// RawlogReader. `progress` gets the share read, [0, 1]. `poses` take the place of the recorded ones; a label
/// that does not occur is a ConfigError.
RawlogReport inspectRawlog(const std::filesystem::path& file,
                           const std::function<void(double)>& progress = nullptr,
                           const SensorPoses& poses = {}, double until_s = 0);

/// The findings for a report (the report's own list is not looked at), worst first.
std::vector<Finding> findProblems(const RawlogReport& report);

}  // namespace roomgraph
