// SPDX-License-Identifier: BSD-3-Clause
// What is read of a recording according to the configuration: sources, sensors, extrinsics.
#pragma once

#include <string>

#include "roomgraph/core/config.h"
#include "roomgraph/datasets/rawlog_reader.h"
#include "roomgraph/pipeline/options.h"

namespace roomgraph {

/// What the options want of a recording: sources that are switched on, chosen sensors, their places and
/// what else [pipeline] calibration_file corrects. Throws
/// ConfigError when [pipeline] sensor_poses makes no sense, and like readCalibration().
ReadOptions readOptionsOf(const Options& options);
/// The same; stamps stay as recorded where boxes are kept apart from their images ([detection] file), by whose stamps they are found.
ReadOptions readOptionsOf(const Options& options, const Config& config);

/// Adds "LABEL=x,y,z,yaw,pitch,roll" (metres, degrees), as given to --pose, to [pipeline] sensor_poses, so
/// that the run can be repeated from its config. Throws ConfigError when it does not have that form.
void placeSensor(Config& config, const std::string& assignment);

/// Names the file as given to --calibration in [pipeline] calibration_file.
void useCalibration(Config& config, const std::string& file);

}  // namespace roomgraph
