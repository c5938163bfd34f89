// SPDX-License-Identifier: BSD-3-Clause
// Declaration of the submap parameters, and the objects made from them.
#include "submap_settings.h"

#include "roomgraph/geometry/degree.h"

namespace roomgraph {

void SubmapSettings::declare(ParameterVisitor& v) {
  v.add("min_range_m", min_range_m, {.doc = "Nearer returns are ignored.", .unit = "m", .min = 0});
  v.add("max_range_m", max_range_m, {.doc = "Farther returns are ignored.", .unit = "m", .min = 0.5});
  v.add("cell_m", cell_m, {.doc = "Cell size of the submaps.", .unit = "m", .min = 0.01, .max = 0.5});
  v.add("scans_per_submap", scans_per_submap, {.doc = "Kept scans in one submap.", .min = 2, .max = 1000});
  v.add("hit_probability", hit_probability,
        {.doc = "Occupancy evidence of one return.", .min = 0.501, .max = 0.99});
  v.add("miss_probability", miss_probability,
        {.doc = "Occupancy evidence of a beam that passes.", .min = 0.01, .max = 0.499});
  v.add("keep_distance_m", keep_distance_m,
        {.doc = "Movement after which a scan is kept.", .unit = "m", .min = 0});
  v.add("keep_angle_deg", keep_angle_deg,
        {.doc = "Turn after which a scan is kept.", .unit = "deg", .min = 0});
  v.add("keep_time_s", keep_time_s,
        {.doc = "Time after which a scan is kept anyway.", .unit = "s", .min = 0});
  v.add("thinning_m", thinning_m,
        {.doc = "One return per square of this side is matched.", .unit = "m", .min = 0.001});
  v.add("max_points", max_points, {.doc = "Most returns matched; thinned further beyond.", .min = 10});
  v.add("min_points", min_points, {.doc = "A scan with fewer returns is not matched.", .min = 3});
}

std::unique_ptr<ActiveSubmaps> SubmapSettings::emptySubmaps() const {
  return std::make_unique<ActiveSubmaps>(cell_m, scans_per_submap,
                                         GridUpdate{hit_probability, miss_probability});
}

MotionFilter SubmapSettings::filter() const {
  return {keep_distance_m, keep_angle_deg * kDegree, keep_time_s};
}

Points2 SubmapSettings::points(const PlanarScan& scan) const {
  return thinnedTo(scan.points, thinning_m, max_points);
}

}  // namespace roomgraph
