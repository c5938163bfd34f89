// SPDX-License-Identifier: BSD-3-Clause
// True objects and landmarks read from JSON; objects seen well enough to count.
#pragma once

#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "roomgraph/geometry/pose.h"

namespace roomgraph {

/// An object of a truth file or of a map; both files use the same fields.
struct EvaluatedObject {
  int id = -1;
  std::string class_name, kind;                        ///< kind: finer than the class, truth files only
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< bottom centre, m
  double yaw = 0;                                      ///< rad
  bool has_yaw = true;
  double width = 0, depth = 0, height = 0;  ///< m
  double existence = 1;
  std::optional<Eigen::Matrix2d> place_covariance;  ///< of x and y, m^2; of landmarks
};

/// Reads objects.json (key `objects`) or landmarks.json (key `landmarks`).
/// Throws InputError naming file, object and field.
std::vector<EvaluatedObject> readObjects(const std::filesystem::path& file);

/// When a true object counts as seen.
struct VisibilityRule {
  int min_frames = 10;
  double min_visible = 0.4;   ///< share of the silhouette, exclusive
  double min_height_px = 40;  ///< of the box, exclusive
  double max_depth_m = 4.5;   ///< median depth, exclusive
};

/// Ids of the objects that are clearly visible in enough frames of boxes.jsonl. Throws InputError with file and line.
std::set<int> readSeenObjects(const std::filesystem::path& boxes_jsonl, const VisibilityRule& rule = {});

}  // namespace roomgraph
