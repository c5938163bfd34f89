// SPDX-License-Identifier: BSD-3-Clause
// All options and stages of a run, made from the configuration.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "roomgraph/association/associator.h"
#include "roomgraph/association/landmark_options.h"
#include "roomgraph/core/config.h"
#include "roomgraph/core/config_schema.h"
#include "roomgraph/detection/detector.h"
#include "roomgraph/lidar/scan_matcher.h"
#include "roomgraph/mapping/occupancy_options.h"
#include "roomgraph/observations/object_database.h"
#include "roomgraph/pipeline/options.h"
#include "roomgraph/proposals/proposal_generator.h"
#include "roomgraph/selection/proposal_selector.h"
#include "roomgraph/tracking/rgbd_odometry.h"

namespace roomgraph {

/// Registers the classes of every library; safe to call again.
void registerAllClasses();

/// Everything a run is made of: options and stages, as the config names them.
struct Stages {
  GeneralOptions general;
  RgbdOptions rgbd;
  TrackingOptions tracking;
  LidarOptions lidar;
  OdometryOptions odometry;
  DetectionStageOptions detection;
  BackendOptions backend;
  ObjectDatabase database;
  std::shared_ptr<RgbdOdometry> rgbd_odometry;       ///< null when switched off
  std::shared_ptr<ScanMatcher> scan_matcher;         ///< null when switched off
  std::shared_ptr<ScanLoopCloser> scan_loop_closer;  ///< null when switched off
  std::shared_ptr<Detector> detector;                ///< null when switched off
  std::shared_ptr<ProposalGenerator> proposal_generator;
  std::shared_ptr<ProposalSelector> proposal_selector;
  std::shared_ptr<Associator> associator;
  LandmarkOptions landmarks;
  ObjectLoopOptions object_loops;
  OccupancyOptions mapping;
  /// INI text of every parameter as it is used, and of the object database, which it expects beside itself as
  /// objects.ini.
  std::string effective_config, objects;
};

/// Loads the plug-ins, makes the stages and gives them their parameters. `objects_file`: the object database
/// when the config names none. Throws ConfigError (unknown section, key, class, value; object database) or
/// InputError (network file).
std::unique_ptr<Stages> makeStages(const Config& config, const std::filesystem::path& objects_file);

/// Every section and key that a config may hold, with all registered implementations.
ConfigSchema configSchema();

}  // namespace roomgraph
