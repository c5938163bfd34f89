// SPDX-License-Identifier: BSD-3-Clause
// Evaluation results as text tables and as JSON.
#pragma once

#include <string>

#include "roomgraph/evaluation/association_error.h"
#include "roomgraph/evaluation/detection_error.h"
#include "roomgraph/evaluation/map_error.h"
#include "roomgraph/evaluation/object_error.h"
#include "roomgraph/evaluation/relations.h"
#include "roomgraph/evaluation/trajectory_error.h"

namespace roomgraph {

/// Tables for people.
std::string toTable(const TrajectoryErrors& errors);
std::string toTable(const RelationErrors& errors);
std::string toTable(const ObjectErrors& errors);
std::string toTable(const AssociationErrors& errors);
std::string toTable(const DetectionErrors& errors);
std::string toTable(const MapErrors& errors);

/// The same figures as one JSON object with stable names; null for figures without data.
std::string toJson(const TrajectoryErrors& errors);
std::string toJson(const RelationErrors& errors);
std::string toJson(const ObjectErrors& errors);
std::string toJson(const ObjectErrors& objects, const AssociationErrors& associations);
std::string toJson(const DetectionErrors& errors);
std::string toJson(const MapErrors& errors);

}  // namespace roomgraph
