// SPDX-License-Identifier: BSD-3-Clause
// Lines of JSON for a frame: its detections, and which landmarks its measurements were given to.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <ostream>
#include <string>
#include <vector>

#include "roomgraph/estimation/object_frames.h"
#include "roomgraph/pipeline/step_report.h"

namespace roomgraph {

/// Names in it may be no UTF-8.
std::string textOf(const nlohmann::ordered_json& json, int indent = -1);

std::string detectionsLine(const StepReport& report);
std::string associationsLine(double t, const std::vector<ObjectDecision>& decisions);
/// Of every frame, in order of time; of sightings that were given up what is known still.
void writeAssociations(std::ostream& out, const ObjectFrames& frames);

}  // namespace roomgraph
