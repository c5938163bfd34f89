// SPDX-License-Identifier: BSD-3-Clause
// People and whatever else moves by itself: where the last frame saw them, for images and scans.
#pragma once

#include <vector>

#include "roomgraph/lidar/dynamic_return_filter.h"
#include "roomgraph/observations/object_database.h"
#include "roomgraph/observations/proposal.h"
#include "roomgraph/observations/scan.h"

namespace roomgraph {

/// Where people stand around the robot, as one frame saw them.
struct PeopleInView {
  double t = 0;
  std::vector<DynamicWedge> wedges;  ///< in the robot's frame
};

/// Boxes, px, of the detections whose class moves by itself.
std::vector<Box2> boxesOfPeople(const std::vector<Detection>& detections, const ObjectDatabase& database);

/// Wedges around the proposals whose class moves by itself.
PeopleInView peopleInView(const FrameProposals& proposals, const Pose3& robot_from_camera,
                          const ObjectDatabase& database);

/// The wedges as the robot sees them after a movement: in its frame then.
PeopleInView seenAfter(const PeopleInView& people, const Pose2& before_from_after);

/// Removes the returns of a scan inside the wedges, as long as those are not too old; returns how many
/// (method.md sec. 5).
int removePeople(Scan& scan, const PeopleInView& people);

}  // namespace roomgraph
