// SPDX-License-Identifier: BSD-3-Clause
// Wedges of people from their proposals, with margins, and for how long they hold.
#include "people_in_view.h"

#include <cmath>

namespace roomgraph {
namespace {

constexpr double kPeopleMaxAge_s = 0.3;  // a person walks .4 m in this time
constexpr double kPersonMargin_m = 0.15, kPersonDepth_m = 0.6;
constexpr double kLeastDistance_m = 0.3;  // nearer, a margin would be a half plane

}  // namespace

std::vector<Box2> boxesOfPeople(const std::vector<Detection>& detections, const ObjectDatabase& database) {
  std::vector<Box2> out;
  for (const auto& detection : detections)
    if (database.moves(detection.class_name)) out.push_back(detection.box);
  return out;
}

PeopleInView peopleInView(const FrameProposals& proposals, const Pose3& robot_from_camera,
                          const ObjectDatabase& database) {
  PeopleInView out{proposals.t, {}};
  for (const auto& proposal : proposals.proposals) {
    if (!database.moves(proposal.class_name)) continue;
    const Eigen::Vector3d place = (robot_from_camera * proposal.camera_from_object).translation();
    const double distance = place.head<2>().norm(), bearing = std::atan2(place.y(), place.x());
    const double half =
        std::atan2(proposal.shape.radius() + kPersonMargin_m, std::max(kLeastDistance_m, distance));
    out.wedges.push_back({bearing - half, bearing + half, distance - kPersonDepth_m, distance + kPersonDepth_m});
  }
  return out;
}

PeopleInView seenAfter(const PeopleInView& people, const Pose2& before_from_after) {
  PeopleInView out = people;
  const Pose2 after_from_before = before_from_after.inverse();
  for (DynamicWedge& wedge : out.wedges) {
    wedge.apex = after_from_before * wedge.apex;
    wedge.angle_min_rad += after_from_before.yaw;
    wedge.angle_max_rad += after_from_before.yaw;
  }
  return out;
}

int removePeople(Scan& scan, const PeopleInView& people) {
  if (people.wedges.empty() || std::abs(people.t - scan.t) > kPeopleMaxAge_s) return 0;
  return removeDynamicReturns(scan, people.wedges);
}

}  // namespace roomgraph
