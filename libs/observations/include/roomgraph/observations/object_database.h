// SPDX-License-Identifier: BSD-3-Clause
// Object database: classes with shape, size prior, symmetry and detector labels.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "roomgraph/core/config_schema.h"
#include "roomgraph/geometry/shape.h"

namespace roomgraph {

/// What tells the front of an object among the sides that its shape allows.
enum class FrontRule {
  kNone,      ///< nothing, or the object has no front
  kHighBack,  ///< the side away from the highest part: seats
  kNearSide   ///< of the sides that fit, the one that is seen: furniture that stands against a wall
};

/// One record of objects.ini (method.md "Object database"): an INI section named after the class.
struct ObjectModel : Configurable {
  std::string class_name;           ///< section name
  std::string place;                ///< "objects.ini:12: [sofa]", for messages
  std::vector<std::string> labels;  ///< detector labels it answers to
  std::string shape = "cuboid";
  double width_m = 1, depth_m = 1, height_m = 1;
  double width_sigma_m = .1, depth_sigma_m = .1, height_sigma_m = .1;
  double place_sigma_m = .02;  ///< of the middle of such an object about that of its shape, along x and y
  int symmetry = 1;  ///< yaw symmetry: 0 any angle, 1 none, 2 by 180 deg, 4 by 90 deg
  bool rests_on_ground = true;
  std::string front = "near_side";   ///< see frontRule()
  double solid_share = 0;            ///< of the height: a lidar beam below it cannot pass through the object
  bool moves = false;                ///< by itself (persons): masked out of odometry, scans and map
  bool landmark = true;              ///< false: detected, never mapped
  std::string generator = "auto";    ///< see generatorName()
  std::string color = "#888888";

  void declareParameters(ParameterVisitor& visitor) override;
  ObjectShape nominal() const;
  /// Standard deviations of width, depth and height, m; at least 1 cm each: a class whose size hardly varies
  /// still leaves some freedom.
  Eigen::Vector3d sizeSigma() const;
  /// Squared distance of a size from the usual one, normalised by sizeSigma().
  double sizeDistance2(const ObjectShape& other) const;
  /// What tells the front; kNone for shapes without a yaw or with symmetric sides.
  FrontRule frontRule() const;
  /// Class name of the shape generator; for "auto" the shipped one of the shape.
  std::string generatorName() const;
};

/// The classes the program knows, from a text file beside config.ini; adding one needs no code.
class ObjectDatabase {
 public:
  /// Throws InputError / ConfigError with file, section and key.
  static ObjectDatabase fromFile(const std::filesystem::path& file);
  static ObjectDatabase fromText(const std::string& text, const std::string& name = "objects");

  const std::vector<ObjectModel>& models() const { return models_; }
  /// By class name; null when unknown.
  const ObjectModel* find(const std::string& class_name) const;
  /// By a detector's label (case-insensitive); null when no class answers to it.
  const ObjectModel* byLabel(const std::string& label) const;
  /// Whether objects of a class move by themselves; false for an unknown class.
  bool moves(const std::string& class_name) const;
  /// Reference of the keys, in Markdown.
  static std::string markdown();

 private:
  static ObjectDatabase fromConfig(const Config& config);
  std::vector<ObjectModel> models_;
};

}  // namespace roomgraph
