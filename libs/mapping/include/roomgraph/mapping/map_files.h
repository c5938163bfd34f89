// SPDX-License-Identifier: BSD-3-Clause
// Reading and writing of map files: landmarks.json, ROS occupancy map; map.rgmap comes with map_file.h.
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "roomgraph/observations/CSemanticMap.h"
#include "roomgraph/observations/map_file.h"
#include "roomgraph/observations/seen_span.h"

namespace roomgraph {

// Every writer replaces the file atomically and throws RunError naming file and cause; every reader throws
// InputError naming file, place and cause. Coordinates are in world: m, rad.

/// Where the objects of a landmarks.json come from.
struct LandmarksOrigin {
  std::string recording, version;  ///< file name; version of the program
  SeenSpans seen;
  std::map<LandmarkId, std::map<std::string, double>> evidence;  ///< for and against existence, by name
};

/// landmarks.json of the interface: a header (frame, units, recording, version), then for each landmark id,
/// class, model, x, y, z, yaw, size_wdh, footprint, covariance, existence, class_posterior, observations,
/// first_seen, last_seen and evidence (where known), `shape` and `has_yaw`.
void saveLandmarksJson(const std::vector<Landmark>& landmarks, const std::filesystem::path& file,
                       const LandmarksOrigin& origin = {});

/// map.pgm + map.yaml as ROS map_server / nav2 read them (254 free, 0 occupied, 205 unknown; first row =
/// largest y); `stem` without extension.
void saveOccupancyRos(const mrpt::maps::COccupancyGridMap2D& grid, const std::filesystem::path& stem);
/// A grid whose corner (0, 0) lies at `origin` in its map's frame, m. MRPT's own corners are multiples of the cell size.
struct PlacedGrid {
  mrpt::maps::COccupancyGridMap2D grid;
  Eigen::Vector2d origin = Eigen::Vector2d::Zero();
};

/// Reads a map_server yaml and its image: cells 1 free, 0 occupied, 0.5 unknown (MRPT: probability of being
/// free).
PlacedGrid loadOccupancyRos(const std::filesystem::path& yaml);

}  // namespace roomgraph
