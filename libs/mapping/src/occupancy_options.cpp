// SPDX-License-Identifier: BSD-3-Clause
// Declaration of the occupancy grid's parameters, with defaults and ranges.
#include "roomgraph/mapping/occupancy_options.h"

namespace roomgraph {
namespace {

void declare(DepthSlice& slice, ParameterVisitor& v) {
  v.add("depth_min_height_m", slice.min_height_m,
        {.doc = "Lower end of the band of heights that counts as an obstacle in depth images.",
         .unit = "m",
         .min = 0.01,
         .max = 2});
  v.add("depth_max_height_m", slice.max_height_m,
        {.doc = "Upper end of the band of heights that counts as an obstacle in depth images.",
         .unit = "m",
         .min = 0.05,
         .max = 5});
  v.add("depth_max_range_m", slice.max_range_m,
        {.doc = "Farther depth measurements are not used.", .unit = "m", .min = 0.5, .max = 50});
  v.add("depth_step_px", slice.step_px,
        {.doc = "Every n-th pixel of a depth image is used.", .unit = "px", .min = 1, .max = 32});
  v.add("depth_beam_rad", slice.beam_rad,
        {.doc = "Width of a beam of the virtual scan that depth images are turned into.",
         .unit = "rad",
         .min = 0.001,
         .max = 0.2});
}

}  // namespace

void OccupancyOptions::declareParameters(ParameterVisitor& v) {
  v.add("source", source,
        {.doc = "Sensor that fills the grid. auto: the lidar; the depth camera where no scan is within 5 s.",
         .choices = {"auto", "lidar", "depth", "both"}});
  v.add("resolution_m", resolution_m, {.doc = "Size of a cell.", .unit = "m", .min = 0.005, .max = 1});
  v.add("max_range_m", max_range_m,
        {.doc = "A farther return only marks the cells up to this distance as free.",
         .unit = "m",
         .min = 0.5,
         .max = 200});
  v.add("no_return_free_m", no_return_free_m,
        {.doc = "A beam without a return marks the cells up to this distance as free. 0: it says nothing.",
         .unit = "m",
         .min = 0,
         .max = 200});
  v.add("hit_probability", hit_probability,
        {.doc = "Probability that a cell with a return is occupied, for one scan.", .min = 0.5, .max = 0.99});
  v.add("pass_probability", pass_probability,
        {.doc = "Probability that a cell crossed by a beam is occupied, for one scan.",
         .min = 0.01,
         .max = 0.5});
  v.add(
      "min_move_m", min_move_m,
      {.doc =
           "A scan is used when the robot has moved this far since the last used one (or turned, or waited).",
       .unit = "m",
       .min = 0,
       .max = 10});
  v.add(
      "min_turn_rad", min_turn_rad,
      {.doc =
           "A scan is used when the robot has turned this far since the last used one (or moved, or waited).",
       .unit = "rad",
       .min = 0,
       .max = 3.2});
  v.add(
      "max_wait_s", max_wait_s,
      {.doc = "A scan is used when this time has passed since the last used one, so that what moved away is "
              "cleared.",
       .unit = "s",
       .min = 0,
       .max = 1e6});
  declare(slice, v);
  v.add("leave_out_moving", leave_out_moving,
        {.doc = "Whether returns of depth images in space that earlier ones saw as free are taken as on people and left out of a grid that is "
                "drawn from them."});
}

}  // namespace roomgraph
