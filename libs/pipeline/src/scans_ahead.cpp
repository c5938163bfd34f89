// SPDX-License-Identifier: BSD-3-Clause
// Which records are matched before their turn, and with what prediction.
#include "scans_ahead.h"

#include "predicted_movement.h"
#include "stage_borders.h"

namespace roomgraph {

ScansAhead::ScansAhead(std::shared_ptr<ScanMatcher> matcher, const std::optional<MotionNoise>& wheels)
    : matcher_(std::move(matcher)), wheels_predict_(wheels), wheels_(wheels.value_or(MotionNoise{}), true) {}

// The same records are left out as in their turn.
void ScansAhead::see(const Record& record) {
  if (!matcher_ || over_ || !problemOfRecord(record).empty()) return;
  over_ = std::holds_alternative<Frame>(record);
  if (const auto* reading = std::get_if<OdometryReading>(&record); reading && wheels_predict_)
    wheels_.add(reading->t, toPose3(reading->odom_from_robot), 0);
  if (const auto* scan = std::get_if<Scan>(&record); scan && (!last_t_ || scan->t > *last_t_)) match(*scan);
}

void ScansAhead::match(const Scan& scan) {
  std::optional<Pose2> prior;
  if (last_t_)
    if (const auto moved = predictedMovement(*last_t_, scan.t, {&wheels_})) prior = planarPart(moved->a_from_b);
  last_t_ = scan.t;
  matches_.put(scan.t, matcher_->match(scan, prior));
}

}  // namespace roomgraph
