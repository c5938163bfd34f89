// SPDX-License-Identifier: BSD-3-Clause
// Description of a simulated world: rooms, furniture, people, paths and sensors.
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "roomgraph/geometry/camera.h"
#include "roomgraph/simulation/mesh.h"

namespace roomgraph {

// A world as its file describes it. Lengths in metres, angles in radians, all in the plan's own frame (z up,
// floor at z = 0); what is simulated from it is expressed in the frame of the robot's first pose.

enum class Side { kNorth, kEast, kSouth, kWest };  ///< +y, +x, -y, -x
enum class DoorState { kNone, kClosed, kHalfOpen, kOpen };

struct Doorway {
  Side side = Side::kNorth;
  double at_m = 0;  ///< middle, x or y of the plan
  double width_m = 0.95, height_m = 2.1;
  DoorState door = DoorState::kNone;
  std::array<double, 3> color{0.55, 0.38, 0.22};
  std::string mesh_file;  ///< replaces frame and leaf; empty: built
  std::string place;      ///< where it stands in the file, for messages
};

struct Poster {
  Side side = Side::kNorth;
  double at_m = 0, z_m = 1.5, width_m = 0.8, height_m = 1.0;
  int variant = 0;
  std::string pattern = "poster";  ///< see texture.h
};

struct Room {
  std::string name;
  Eigen::Vector2d min_m, max_m;  ///< inner faces of its walls
  Material wall, floor;
  std::vector<Doorway> doorways;
  std::vector<Poster> posters;
  std::string place;
};

/// Another place, where furniture stands from then on.
struct FurnitureMove {
  double at_s = 0;
  Eigen::Vector3d at_m = Eigen::Vector3d::Zero();  ///< bottom centre
  double yaw_rad = 0;
};

struct Furniture {
  std::string model;                               ///< see models.h
  Eigen::Vector3d at_m = Eigen::Vector3d::Zero();  ///< bottom centre
  double yaw_rad = 0;                              ///< direction of the front
  std::optional<Eigen::Vector3d> size_m;           ///< w, d, h; otherwise the model's own
  std::optional<std::array<double, 3>> color;
  int shape = 0;          ///< proportions of a seat: 0 the usual ones, any other number others
  std::string mesh_file;  ///< replaces the built shape, fitted to the size; empty: built
  std::string place;
  std::vector<FurnitureMove> moves;  ///< by time
};

struct Person {
  std::vector<Eigen::Vector2d> path_m;  ///< one point: stays there
  double speed_m_s = 0.7, start_s = 0, yaw_rad = 0;
  bool sits = false;
  double seat_height_m = 0.47, height_m = 1.75;
  std::array<double, 3> shirt{0.2, 0.3, 0.6}, trousers{0.15, 0.15, 0.2}, skin{0.85, 0.65, 0.52},
      hair{0.2, 0.13, 0.08};
  std::string mesh_file;  ///< replaces the built body, which then glides without moving its limbs
  std::string place;
};

struct RobotPathSpec {
  std::vector<Eigen::Vector2d> path_m;
  bool closed = false;  ///< returns to the first point
  double max_speed_m_s = 0.45, max_turn_rad_s = 0.6, acceleration_m_s2 = 0.4, radius_m = 0.18;
  std::string place;
};

/// One view of a hand-held camera's path.
struct HandheldKey {
  Eigen::Vector3d at_m, look_at_m;
};

struct HandheldSpec {
  std::vector<HandheldKey> keys;
  bool closed = false;
  double speed_m_s = 0.35;
  std::string place;
};

struct CameraSpec {
  PinholeCamera model{640, 480, 525, 525, 319.5, 239.5, {}};
  double rate_hz = 10;
  Eigen::Vector3d at_m{0.05, 0, 0.8};  ///< in the robot frame
  double pitch_down_rad = 0.2094395102393195;
  double near_m = 0.45, far_m = 5.0;
  double baseline_m = 0.075, focal_px = 580, disparity_step_px = 0.125;  ///< of the depth sensor
  double noise_gain = 1;  ///< 0: exact depth, quantised to the unit of 1 mm only; no colour noise
  int jpeg_quality = 86;
};

struct LidarSpec {
  int beams = 360;
  double rate_hz = 10, delay_s = 0.03;
  Eigen::Vector3d at_m{0.05, 0, 0.25};
  double min_m = 0.15, max_m = 8;
  double sigma_m = 0.01, sigma_relative = 0.01, dropouts = 0.01;
};

struct OdometrySpec {
  double rate_hz = 20;
  double scale_error = 0.03;  ///< measured length = (1 + scale_error) * true length
  double turn_error = 0.02;
  double drift_rad_m = 0.01;             ///< heading error gained per metre
  double sigma_length = 0.03;            ///< m per sqrt(m)
  double sigma_turn = 0.03;              ///< rad per sqrt(rad)
  int slips = 2;                         ///< times that the wheels spin
  double slip_m = 0.15, slip_rad = 0.1;  ///< spread of what such a slip adds
};

/// A simulated detector errs independently in every frame, or persistently: the same way from the same view.
struct DetectionsSpec {
  double detect_probability = 0.9, min_visible = 0.25, min_height_px = 20;
  double jitter = 0.03;           ///< sigma of every edge, share of the box's size
  double false_positives = 0.05;  ///< expected per frame
  double confusion = 0.03;        ///< independent: probability of a wrong label
  double mislead = 1;             ///< persistent: gain on how often things of other kinds get a label
  double duplicates = 0.03;       ///< persistent: share of the objects' views with a second box
  double memory_s = 0.8;          ///< persistent: time over which an error that is not of the view lasts
  bool persistent = false;
};

struct World {
  std::string name, file;
  std::optional<double> duration_s;  ///< default: until the path ends
  double wall_height_m = 2.6, wall_thickness_m = 0.12;
  double light = 1;  ///< brightness of the colour pictures before the sensor's noise
  std::vector<Room> rooms;
  std::vector<Furniture> furniture;
  std::vector<Person> people;
  std::optional<RobotPathSpec> robot;
  std::optional<HandheldSpec> handheld;
  std::optional<CameraSpec> camera;
  std::optional<LidarSpec> lidar;
  std::optional<OdometrySpec> odometry;
  std::optional<DetectionsSpec> detections;
};

}  // namespace roomgraph
