// SPDX-License-Identifier: BSD-3-Clause
// The exchangeable stages of a run.
#pragma once

#include <memory>
#include <vector>

#include "roomgraph/association/associator.h"
#include "roomgraph/detection/detector.h"
#include "roomgraph/lidar/scan_matcher.h"
#include "roomgraph/proposals/ground_detector.h"
#include "roomgraph/proposals/proposal_generator.h"
#include "roomgraph/selection/proposal_selector.h"
#include "roomgraph/tracking/rgbd_odometry.h"

namespace roomgraph {

/// Stage objects, made by the class names in the configuration. The first four are null when switched off.
struct Stages {
  std::shared_ptr<RgbdOdometry> rgbd_odometry;
  std::shared_ptr<ScanMatcher> scan_matcher;
  std::shared_ptr<ScanLoopCloser> scan_loop_closer;
  std::shared_ptr<Detector> detector;
  std::shared_ptr<GroundDetector> ground_detector;
  ShapeGenerators shape_generators;  ///< those that the object database names
  std::shared_ptr<ProposalGenerator> proposal_generator;
  std::shared_ptr<ProposalSelector> proposal_selector;
  std::shared_ptr<Associator> associator;
};

/// Those that there are, but the generators of single shapes.
std::vector<Stage*> allOf(const Stages& stages);

}  // namespace roomgraph
