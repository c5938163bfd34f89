// SPDX-License-Identifier: BSD-3-Clause
// Declaration of the submap parameters, and the objects made from them.
#include "submap_settings.h"

namespace roomgraph {

void SubmapSettings::declare(ParameterVisitor& v) {
  v.add("min_range_m", min_range_m, {.doc = "Nearer returns are ignored.", .unit = "m", .min = 0, .max = 10});
  v.add("max_range_m", max_range_m,
        {.doc = "Farther returns are ignored.", .unit = "m", .min = 0.5, .max = 1000});
  v.add("cell_m", cell_m, {.doc = "Cell size of the submaps.", .unit = "m", .min = 0.01, .max = 0.5});
  v.add("scans_per_submap", scans_per_submap,
        {.doc = "Number of scans in one submap.", .min = 2, .max = 1000});
  v.add("hit_probability", hit_probability,
        {.doc = "Probability that the cell of a return is occupied.", .min = 0.501, .max = 0.99});
  v.add("miss_probability", miss_probability,
        {.doc = "Probability that a cell is occupied that a beam passes.", .min = 0.01, .max = 0.499});
  v.add("keep_distance_m", keep_distance_m,
        {.doc = "A scan is kept for the submap after this movement.", .unit = "m", .min = 0, .max = 10});
  v.add("keep_angle_rad", keep_angle_rad,
        {.doc = "A scan is kept for the submap after this turn.", .unit = "rad", .min = 0, .max = 3.2});
  v.add("keep_time_s", keep_time_s,
        {.doc = "A scan is kept for the submap after this time without movement.",
         .unit = "s",
         .min = 0,
         .max = 1000});
  v.add("thinning_m", thinning_m,
        {.doc = "Returns are thinned to one per square of this side before matching.",
         .unit = "m",
         .min = 0.001,
         .max = 1});
  v.add(
      "max_points", max_points,
      {.doc = "Returns are thinned further until at most this many are matched.", .min = 10, .max = 100000});
  v.add("min_points", min_points,
        {.doc = "A scan with fewer returns is not matched.", .min = 3, .max = 10000});
}

std::unique_ptr<ActiveSubmaps> SubmapSettings::emptySubmaps() const {
  return std::make_unique<ActiveSubmaps>(cell_m, scans_per_submap,
                                         GridUpdate{hit_probability, miss_probability});
}

MotionFilter SubmapSettings::filter() const {
  return {keep_distance_m, keep_angle_rad, keep_time_s};
}

PlanarScan SubmapSettings::planar(const Scan& scan) const {
  return toPlanarScan(scan, min_range_m, max_range_m);
}

Points2 SubmapSettings::points(const PlanarScan& scan) const {
  return thinnedTo(scan.points, thinning_m, max_points);
}

}  // namespace roomgraph
