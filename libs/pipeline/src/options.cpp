// SPDX-License-Identifier: BSD-3-Clause
// Declarations of the parameters of every pipeline section, with defaults and ranges.
#include "roomgraph/pipeline/options.h"

namespace roomgraph {

void GeneralOptions::declareParameters(ParameterVisitor& v) {
  v.add("plugins", plugins,
        {.doc = "shared libraries with further stages, loaded before the stages are made", .file = true});
  v.add("objects_file", objects_file,
        {.doc = "object database; empty: objects.ini beside the config file, else the one shipped with the "
                "program",
         .file = true});
  v.add("lookahead_s", lookahead_s,
        {.doc = "records are put in order of time within this span", .unit = "s", .min = 0, .max = 10});
  v.add("sensor_poses", sensor_poses,
        {.doc = "places of cameras and lidars on the robot that replace the recorded ones: "
                "LABEL=x,y,z,yaw,pitch,roll in metres and degrees, several separated by commas"});
}

namespace {

void declareLabel(std::string& label, ParameterVisitor& v) {
  v.add("label", label, {.doc = "sensor label of the one to use; empty: the first that appears"});
}

}  // namespace

void RgbdOptions::declareParameters(ParameterVisitor& v) {
  declareLabel(label, v);
}

void TrackingOptions::declareParameters(ParameterVisitor& v) {
  v.add("enabled", enabled, {.doc = "use RGB-D odometry"});
  v.add("class", stage, {.doc = "implementation of RgbdOdometry"});
  v.add("loop_closing", loop_closing, {.doc = "use loop closures found in images"});
  noise.declare(v);
}

void LidarOptions::declareParameters(ParameterVisitor& v) {
  v.add("enabled", enabled, {.doc = "use 2D scans"});
  v.add("class", stage, {.doc = "implementation of ScanMatcher"});
  declareLabel(label, v);
  v.add("loop_closing", loop_closing, {.doc = "use loop closures found in scans"});
  noise.declare(v);
}

void OdometryOptions::declareParameters(ParameterVisitor& v) {
  v.add("enabled", enabled, {.doc = "use wheel odometry"});
  declareLabel(label, v);
  noise.declare(v);
}

void DetectionStageOptions::declareParameters(ParameterVisitor& v) {
  v.add("enabled", enabled, {.doc = "detect and map objects"});
  v.add("class", detector,
        {.doc =
             "implementation of Detector; auto: AutoDetector, which runs the networks in `models` when there "
             "are some and else replays recorded boxes"});
  v.add("every_nth_frame", every_nth_frame,
        {.doc = "the detector runs on every frame (1), every second one (2) …; recorded boxes are taken as often",
         .min = 1,
         .max = 1000});
  v.add("track_boxes", track_boxes,
        {.doc = "on frames on which the detector does not run (or that have no record) the boxes are carried "
                "on by tracking them in the image"});
  v.add("max_carried_frames", max_carried_frames,
        {.doc = "a box is carried over at most this many frames", .min = 0, .max = 1000});
}

void StageChoice::declareParameters(ParameterVisitor& v) {
  v.add("class", stage, {.doc = "implementation of this stage"});
}

}  // namespace roomgraph
