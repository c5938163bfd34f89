// SPDX-License-Identifier: BSD-3-Clause
// Declaration of the feature odometry's parameters with units and ranges.
#include "tracking_parameters.h"

namespace roomgraph {
namespace {

void declareMeasurements(ParameterVisitor& v, TrackingParameters& p) {
  v.add("max_features", p.max_features, {.doc = "Number of features per image.", .min = 50, .max = 10000});
  v.add("pyramid_levels", p.pyramid_levels,
        {.doc = "Number of levels of the image pyramid.", .min = 1, .max = 12});
  v.add("scale_factor", p.scale_factor, {.doc = "Size ratio of two pyramid levels.", .min = 1.05, .max = 2});
  v.add("fast_threshold", p.fast_threshold,
        {.doc = "Least grey difference of a FAST corner.", .min = 1, .max = 100});
  v.add("cell_px", p.cell_px,
        {.doc = "Size of the cells over which the features are spread evenly.",
         .unit = "px",
         .min = 8,
         .max = 200});
  v.add("pixel_sigma_px", p.pixel_sigma_px,
        {.doc = "Noise of a feature's pixel on the finest level.", .unit = "px", .min = 0.05, .max = 10});
  v.add("depth_sigma_base_m", p.depth_sigma_base_m,
        {.doc = "Depth noise at z = 0: sigma_z = base + quadratic z^2.", .unit = "m", .min = 1e-5, .max = 1});
  v.add("depth_sigma_quadratic", p.depth_sigma_quadratic,
        {.doc = "Growth of the depth noise with z^2.", .unit = "1/m", .min = 0, .max = 1});
  v.add("max_depth_m", p.max_depth_m,
        {.doc = "Depths beyond are not used.", .unit = "m", .min = 0.5, .max = 100});
  v.add("max_depth_step", p.max_depth_step,
        {.doc = "A depth is not used where the depth around it varies by more than this share of it.",
         .min = 0.001,
         .max = 10});
}

void declareMatching(ParameterVisitor& v, TrackingParameters& p) {
  v.add("search_radius_px", p.search_radius_px,
        {.doc = "Search radius around the predicted pixel of a point of the last frame.",
         .unit = "px",
         .min = 1,
         .max = 200});
  v.add("local_map_radius_px", p.local_map_radius_px,
        {.doc = "Search radius for points of the local map once the pose is known.",
         .unit = "px",
         .min = 1,
         .max = 50});
  v.add("max_hamming", p.max_hamming,
        {.doc = "Largest Hamming distance of two 256-bit descriptors that match.", .min = 10, .max = 128});
  v.add("match_ratio", p.match_ratio,
        {.doc = "Largest ratio of the best to the second best descriptor distance.", .min = 0.1, .max = 1});
  v.add("min_inliers", p.min_inliers, {.doc = "Tracking is lost with fewer inliers.", .min = 6, .max = 1000});
}

void declareMap(ParameterVisitor& v, TrackingParameters& p) {
  v.add(
      "keyframe_inlier_ratio", p.keyframe_inlier_ratio,
      {.doc =
           "A new keyframe is made when fewer than this share of the reference keyframe's points is tracked.",
       .min = 0.1,
       .max = 1});
  v.add("keyframe_distance_m", p.keyframe_distance_m,
        {.doc = "A new keyframe is made after this movement.", .unit = "m", .min = 0.01, .max = 10});
  v.add("keyframe_angle_rad", p.keyframe_angle_rad,
        {.doc = "A new keyframe is made after this rotation.", .unit = "rad", .min = 0.01, .max = 3});
  v.add("local_keyframes", p.local_keyframes,
        {.doc = "Number of keyframes whose points form the local map.", .min = 1, .max = 200});
  v.add("keyframes_kept", p.keyframes_kept,
        {.doc = "When there are more, keyframes are given up that show what an older one shows from nearly the same place, found as "
                "loops are (loop_candidates; 0: none is given up).",
         .min = 0,
         .max = 10000000});
  v.add("ba_window", p.ba_window,
        {.doc = "Number of keyframes that local bundle adjustment optimises.", .min = 1, .max = 100});
  v.add("ba_fixed_keyframes", p.ba_fixed_keyframes,
        {.doc = "Further keyframes that are held fixed in local bundle adjustment.", .min = 0, .max = 200});
  v.add("ba_iterations", p.ba_iterations,
        {.doc = "Iterations of local bundle adjustment; 0: none.", .min = 0, .max = 100});
}

void declareRecovery(ParameterVisitor& v, TrackingParameters& p) {
  v.add("relocalisation_frames", p.relocalisation_frames,
        {.doc = "Frames that are tried against old keyframes after a loss, before a new segment starts.",
         .min = 0,
         .max = 1000});
  v.add("relocalisation_candidates", p.relocalisation_candidates,
        {.doc = "Keyframes tried per frame when lost.", .min = 1, .max = 1000});
  v.add("relocalisation_min_inliers", p.relocalisation_min_inliers,
        {.doc = "Least inliers for a pose found again in an old keyframe.", .min = 6, .max = 1000});
  v.add("dense_alignment", p.dense_alignment,
        {.doc = "Whether frames that features do not place, and whose movement no scans saw, are aligned by depth "
                "and brightness."});
  v.add("loop_candidates", p.loop_candidates,
        {.doc = "Old keyframes tried for a loop closure per keyframe; 0: none.", .min = 0, .max = 50});
  v.add("loop_min_gap", p.loop_min_gap,
        {.doc = "Least number of keyframes between the two ends of a loop.", .min = 1, .max = 10000});
  v.add("loop_min_inliers", p.loop_min_inliers,
        {.doc = "Least inliers of a loop closure.", .min = 10, .max = 1000});
  v.add("covariance_scale", p.covariance_scale,
        {.doc = "Factor on the covariance that the Hessian gives, which takes errors as independent.",
         .min = 0.01,
         .max = 1000});
  v.add("min_step_sigma_m", p.min_step_sigma_m,
        {.doc = "Least standard deviation of a step's translation.", .unit = "m", .min = 1e-6, .max = 1});
  v.add("min_step_sigma_rad", p.min_step_sigma_rad,
        {.doc = "Least standard deviation of a step's rotation.", .unit = "rad", .min = 1e-6, .max = 1});
  v.add("min_loop_sigma_m", p.min_loop_sigma_m,
        {.doc = "Least standard deviation of a loop closure's translation.",
         .unit = "m",
         .min = 1e-6,
         .max = 1});
  v.add("min_loop_sigma_rad", p.min_loop_sigma_rad,
        {.doc = "Least standard deviation of a loop closure's rotation.",
         .unit = "rad",
         .min = 1e-6,
         .max = 1});
}

}  // namespace

void TrackingParameters::declareParameters(ParameterVisitor& visitor) {
  declareMeasurements(visitor, *this);
  declareMatching(visitor, *this);
  declareMap(visitor, *this);
  declareRecovery(visitor, *this);
}

}  // namespace roomgraph
