// SPDX-License-Identifier: BSD-3-Clause
// Part of roomgraph, object-level semantic SLAM.
#pragma once

#include <filesystem>

#include "roomgraph/observations/CSemanticMap.h"

namespace roomgraph {

/// Writes / reads map.rgmap (MRPT archive, gzipped). Throws RunError / InputError naming file and cause.
void saveMap(const CSemanticMap& map, const std::filesystem::path& file);
CSemanticMap loadMap(const std::filesystem::path& file);

/// landmarks.json of the interface: id, class, model, x, y, z, yaw, size_wdh, footprint, covariance, existence,
/// class_posterior, observations.
void saveLandmarksJson(const std::vector<Landmark>& landmarks, const std::filesystem::path& file);

/// map.pgm + map.yaml as ROS map_server reads them (255 free, 0 occupied, 205 unknown); `stem` without extension.
void saveOccupancyRos(const mrpt::maps::COccupancyGridMap2D& grid, const std::filesystem::path& stem);

}  // namespace roomgraph
