// SPDX-License-Identifier: BSD-3-Clause
// What sensors that measure the same movements differently say about the robot.
#pragma once

#include <vector>

#include "roomgraph/datasets/rawlog_report.h"
#include "roomgraph/estimation/movement_agreement.h"

namespace roomgraph {

/// Sensors whose pose on the robot is turned, and sensors that contradict the others, in words, with the stamps from which on they do.
std::vector<Finding> movementFindings(const MovementAgreement& agreement);

}  // namespace roomgraph
