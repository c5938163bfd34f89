// SPDX-License-Identifier: BSD-3-Clause
// Calibration and tables of numbers of an OpenLORIS-Scene folder.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "roomgraph/core/outcome.h"
#include "roomgraph/geometry/camera.h"
#include "roomgraph/geometry/pose.h"

namespace roomgraph::openloris {

/// A camera of sensors.yaml. Fails: no such file, no such camera, a model that is not known, numbers that
/// cannot be.
Outcome<PinholeCamera> readCamera(const std::filesystem::path& file, const std::string& name);

/// base_from_frame: product of the matrices of trans_matrix.yaml (parent_from_child) from `base` to `frame`.
/// Fails: no such file, no chain, a matrix that is no transform.
Outcome<Pose3> readPlace(const std::filesystem::path& file, const std::string& base,
                         const std::string& frame);

/// Rows of at least `columns` finite numbers; comments are passed over.
struct NumberTable {
  std::vector<std::vector<double>> rows;
  int broken = 0;        ///< lines that are none
  int first_broken = 0;  ///< number of the first of these
};
/// Throws InputError when the file cannot be read.
NumberTable readTable(const std::filesystem::path& file, std::size_t columns);

/// x y z qx qy qz qw from a column on; nothing when it is no rotation.
Outcome<Pose3> poseOfRow(const std::vector<double>& row, std::size_t column);

}  // namespace roomgraph::openloris
