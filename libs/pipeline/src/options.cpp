// SPDX-License-Identifier: BSD-3-Clause
// Declarations of the parameters of every pipeline section, with defaults and ranges.
#include "roomgraph/pipeline/options.h"

namespace roomgraph {

void GeneralOptions::declareParameters(ParameterVisitor& v) {
  v.add("plugins", plugins,
        {.doc = "Plug-ins: shared libraries with further classes, loaded before the stages are made.",
         .file = true});
  v.add("objects_file", objects_file,
        {.doc = "Object database. Empty: objects.ini beside the config file, else the one shipped with the "
                "program.",
         .file = true});
  v.add("lookahead_s", lookahead_s,
        {.doc = "Records that arrive late by up to this time are put in order.",
         .unit = "s",
         .min = 0,
         .max = 10});
  v.add("set_clocks", set_clocks,
        {.doc = "Whether a run begins anew, with stamps corrected, once the turns, starts and stops that its sensors measure show that "
                "their clocks differ; and whether time goes on where the clocks of all are set back."});
  v.add("set_poses", set_poses,
        {.doc = "Whether a run begins anew, with the recorded poses of camera and lidar turned, once their ways, straight ahead, or the floor "
                "that the camera sees show that they are wrong; none is with poses of sensor_poses or calibration_file."});
  v.add("calibration_file", calibration_file,
        {.doc = "Calibration applied to the records as they are read: sensor poses, time offsets, wheels, "
                "depth (docs/calibration.md). Empty: none.",
         .file = true});
  v.add("sensor_poses", sensor_poses,
        {.doc = "Poses of cameras and lidars on the robot that replace those of the recording and of the calibration: "
                "LABEL=x,y,z,yaw,pitch,roll in metres and, as an exception, degrees; several separated by "
                "commas."});
}

namespace {

void declareLabel(std::string& label, ParameterVisitor& v) {
  v.add("label", label,
        {.doc = "Sensor label of the sensor to use. Empty: the first of its kind in the recording."});
}

}  // namespace

void RgbdOptions::declareParameters(ParameterVisitor& v) {
  declareLabel(label, v);
}

void TrackingOptions::declareParameters(ParameterVisitor& v) {
  v.add("enabled", enabled, {.doc = "Whether RGB-D odometry is used."});
  v.add("class", stage, {.doc = "Class of the RGB-D odometry."});
  v.add("loop_closing", loop_closing, {.doc = "Whether loop closures found in images are used."});
  noise.declare(v);
  noise.declareDrift(v);
}

void LidarOptions::declareParameters(ParameterVisitor& v) {
  v.add("enabled", enabled, {.doc = "Whether 2D scans are used."});
  v.add("class", stage, {.doc = "Class of the scan matcher."});
  declareLabel(label, v);
  v.add("loop_closing", loop_closing, {.doc = "Whether loop closures found in scans are used."});
  noise.declare(v);
  noise.declareDrift(v);
}

void OdometryOptions::declareParameters(ParameterVisitor& v) {
  v.add("enabled", enabled, {.doc = "Whether wheel odometry is used."});
  declareLabel(label, v);
  v.add("calibrate", calibrate,
        {.doc = "Whether the scale of lengths and turns, and the drift, of the wheels are learnt from scans, or from images where there are "
                "none, and taken out."});
  noise.declare(v);
}

void DetectionStageOptions::declareParameters(ParameterVisitor& v) {
  v.add("enabled", enabled, {.doc = "Whether objects are detected and mapped."});
  v.add(
      "class", detector,
      {.doc = "Class of the detector. auto: AutoDetector, which runs the networks named in `models` or, when "
              "there are none, replays recorded boxes."});
  v.add("every_nth_frame", every_nth_frame,
        {.doc = "The detector runs on every n-th frame; recorded boxes are taken as often.",
         .min = 1,
         .max = 1000});
  v.add("rate_hz", rate_hz,
        {.doc = "The detector runs on at most so many frames a second, evenly spread, whatever the camera's rate; "
                "0: on every frame that every_nth_frame chooses.",
         .unit = "Hz",
         .min = 0,
         .max = 1000});
  v.add(
      "track_boxes", track_boxes,
      {.doc =
           "Whether boxes are tracked through the frames on which the detector does not run, or that have no "
           "record."});
  v.add("max_carried_frames", max_carried_frames,
        {.doc = "Frames over which a box is tracked at most.", .min = 0, .max = 1000});
}

void StageChoice::declareParameters(ParameterVisitor& v) {
  v.add("class", stage, {.doc = "Class of this stage."});
}

}  // namespace roomgraph
