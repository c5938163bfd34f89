// SPDX-License-Identifier: BSD-3-Clause
// Simulated scene: parts, objects with true poses, and motion over time.
#pragma once

#include <string>
#include <vector>

#include "person_model.h"
#include "roomgraph/simulation/mesh.h"
#include "roomgraph/simulation/world.h"
#include "sensor_path.h"

namespace roomgraph {

/// Ground truth of one object. The world frame is the robot's first pose.
struct SceneObject {
  int id = 0;  ///< from 1
  std::string class_name, kind, model;
  Eigen::Vector3d size_wdh;  ///< m
  Pose3 world_from_object;   ///< bottom centre, x to the front; at the first instant when it moves by itself
  std::vector<std::pair<double, Pose3>> moves;  ///< of furniture: world_from_object from so many seconds on, by time
  std::vector<Eigen::Vector2d> footprint;  ///< world; hull of what is lower than 1 m
  bool moving = false;
};

/// One rigid piece of the scene.
struct ScenePart {
  Mesh mesh;        ///< of all but persons: in world, at the first instant
  int object = -1;  ///< index of objects(); -1: the building
  int person = -1;  ///< index of the person it belongs to; -1: none
  bool fixed = true;  ///< it never moves
  Eigen::Vector3d center = Eigen::Vector3d::Zero();  ///< of a sphere around the mesh, in the mesh's frame
  double radius = 0;
};

/// Geometry, true object poses and motion of a simulated world. Immutable.
class Scene {
 public:
  explicit Scene(const World& world);

  const std::vector<SceneObject>& objects() const { return objects_; }
  const std::vector<ScenePart>& parts() const { return parts_; }
  const std::vector<Material>& materials() const { return materials_.all(); }
  /// world_from_part of every part.
  std::vector<Pose3> partPoses(double seconds) const;
  /// Of an object that does not move by itself.
  const Pose3& worldFromObject(int object, double seconds) const;
  /// (object index, world_from_person) of everybody.
  std::vector<std::pair<int, Pose2>> persons(double seconds) const;
  /// Robot base in the world; for a hand-held camera: the camera, x ahead and z up in the image.
  Pose3 worldFromRobot(double seconds) const;
  Pose3 worldFromCamera(double seconds) const { return worldFromRobot(seconds) * robot_from_camera_; }
  /// Optical frame.
  const Pose3& robotFromCamera() const { return robot_from_camera_; }
  double duration() const { return duration_s_; }

 private:
  void add(SceneObject object, const Mesh& mesh_in_plan);
  void addPart(Mesh mesh, int object, int person);
  void addDoors(const World& world);
  void addFurniture(const World& world);
  void addPeople(const World& world);
  void setPath(const World& world);

  MaterialList materials_;
  std::vector<SceneObject> objects_;
  std::vector<ScenePart> parts_;
  std::vector<PersonModel> people_;
  std::vector<PersonWalk> walks_;
  std::vector<int> person_objects_;
  std::vector<SensorPath> path_;  ///< one
  Pose3 world_from_plan_ = Pose3::Identity(), robot_from_camera_ = Pose3::Identity();
  double duration_s_ = 0;
};

}  // namespace roomgraph
