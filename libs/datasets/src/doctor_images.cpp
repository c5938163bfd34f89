// SPDX-License-Identifier: BSD-3-Clause
// Checks of intrinsics, depth unit and sensor pose against floor and lidar.
#include <cmath>

#include "findings.h"
#include "roomgraph/geometry/degree.h"

namespace roomgraph {
namespace {

constexpr double kLeastHeightM = 0.1;  // of a sensor on a robot; lower ones are not placed at all
constexpr double kAnyTilt = 0.35;  // rad; a floor seen steeper than this is another problem than the scale

double mountedHeight(const SensorReport& sensor) {
  return sensor.robot_from_sensor ? sensor.robot_from_sensor->translation().z() : 0;
}

void checkCamera(const char* which, const PinholeCamera& camera, int width, Findings& out) {
  if (width == 0) return;
  if (!camera.valid()) {
    out.error(format("no %s intrinsics that fit the image size", which),
              "set cameraParams to the calibration");
    return;
  }
  if (!camera.sees(camera.cx, camera.cy)) {
    out.error(format("%s principal point (%.1f, %.1f) lies outside the image", which, camera.cx, camera.cy),
              "check the calibration and the image size it was made for");
    return;
  }
  const double off_x = std::abs(camera.cx / camera.width - 0.5),
               off_y = std::abs(camera.cy / camera.height - 0.5);
  const double view = 2 * std::atan(0.5 * camera.width / camera.fx) * kDegreesPerRadian;
  if (off_x > 0.3 || off_y > 0.3)
    out.warning(format("%s principal point (%.1f, %.1f) is far from the centre", which, camera.cx, camera.cy),
                "check the calibration and the image size it was made for");
  if (view < 15 || view > 150)
    out.warning(format("%s field of view is %.0f deg wide", which, view), "check the focal length");
}

// A factor between the depth images and something that knows better: the unit of one of them is wrong.
bool isFarOff(double factor) {
  return factor > 2 || factor < 0.5;
}

// What the depth unit may be compared with, the surest first. Rooms are small for a camera whose unit is too
// large; everything is within reach of one whose unit is too small. False when the unit is in doubt.
bool checkDepthScale(const SensorReport& sensor, const std::string& hint, Findings& out) {
  constexpr double kFarMedianM = 6, kShortRangeM = 1.4, kNearM = 0.25, kArmLengthM = 1;
  const auto& images = *sensor.images;
  const std::string unit = format("the depth unit (%.3g m)", images.depth_unit_m);
  const double mounted_m = mountedHeight(sensor);
  if (images.range_over_lidar) {
    if (!isFarOff(*images.range_over_lidar)) return true;
    out.error(format("depth images see walls %.2g times as far away as the lidar: %s is wrong",
                     *images.range_over_lidar, unit.c_str()),
              hint);
  } else if (images.floor && mounted_m > kLeastHeightM && images.floor->tilt_rad < kAnyTilt) {
    const double factor = images.floor->sensor_height_m / mounted_m;
    if (!isFarOff(factor)) return true;
    out.warning(
        format("the floor is seen %.2f m below the camera, which should be %.2f m above it: %s is wrong "
               "by a factor of %.2g, or the height of the camera",
               images.floor->sensor_height_m, mounted_m, unit.c_str(), factor),
        hint);
  } else if (images.median_depth_m > kFarMedianM) {
    out.warning(format("median depth is %.1f m, far for an RGB-D camera in a room: %s may be too large",
                       images.median_depth_m, unit.c_str()),
                hint);
  } else if (images.far_depth_m < (images.near_depth_m < kNearM ? kShortRangeM : kArmLengthM)) {
    out.warning(format("depths are %.2f to %.2f m, very near for an RGB-D camera: %s may be too small",
                       images.near_depth_m, images.far_depth_m, unit.c_str()),
                hint);
  } else {
    return true;
  }
  return false;
}

bool checkDepth(const SensorReport& sensor, Findings& out) {
  const auto& images = *sensor.images;
  constexpr double kNearestM = 0.1, kFarthestM = 50, kCoarsestUnitM = 0.1;
  if (images.depth == 0) {
    out.warning("colour without depth", "objects cannot be measured without depth");
    return true;
  }
  const std::string unit_hint =
      "rangeUnits must be the metres of one step of rangeImage (usually 0.001; TUM and ICL-NUIM: 0.0002)";
  bool good = false;
  if (images.valid_depth_share == 0) {
    out.error("depth images are empty", "no pixel has a depth: check the driver or the conversion");
  } else if (images.median_depth_m < kNearestM || images.median_depth_m > kFarthestM) {
    out.error(format("median depth is %.3g m: the depth unit (%.3g m) is wrong", images.median_depth_m,
                     images.depth_unit_m),
              unit_hint);
  } else if (images.depth_unit_m >= kCoarsestUnitM) {
    out.error(format("depth unit of %.3g m is too coarse", images.depth_unit_m), unit_hint);
  } else {
    good = checkDepthScale(sensor, unit_hint, out);
  }
  if (images.color > 0 && !images.registered)
    out.note("depth is not registered to colour",
             "it is projected into the colour image when read; gaps may appear");
  if (!images.range_is_depth)
    out.note("depth images hold ranges along the ray", "converted to depth when read");
  return good;
}

// Some of the images; when all lack depth, checkDepth() says so.
void checkPoorImages(const ImageSummary& images, Findings& out) {
  if (images.blank.count > 0)
    out.warning(format("%d of %d pictures show nothing; first at t = %.3f s", images.blank.count,
                       images.looked_at, images.blank.first_time),
                "was the lens covered, or the room dark? They cannot be tracked");
  if (images.without_depth.count > 0 && images.valid_depth_share > 0)
    out.warning(format("%d of %d depth images are empty; first at t = %.3f s", images.without_depth.count,
                       images.looked_at, images.without_depth.first_time),
                "did the depth sensor fail? Objects are not measured in them");
  if (images.noisy.count > 0)
    out.warning(format("%d of %d depth images are much noisier than the others; first at t = %.3f s",
                       images.noisy.count, images.looked_at, images.noisy.first_time),
                "what is measured in them is doubtful");
}

}  // namespace

bool checkImages(const SensorReport& sensor, Findings& out) {
  const auto& images = *sensor.images;
  if (images.external_missing > 0) {
    const auto text = format("%d of %d records lack their image file, e.g. %s", images.external_missing,
                             images.external_missing + images.external_present, images.first_missing.c_str());
    const std::string hint = "put the images into the folder <rawlog>_Images beside the rawlog";
    if (images.external_present == 0)
      out.error(text, hint);
    else
      out.warning(text, hint);
  }
  if (images.color + images.depth == 0) {
    if (images.external_missing == 0)
      out.error("no images in the records", "only points or nothing was recorded");
    return true;
  }
  checkPoorImages(images, out);
  checkCamera("colour", images.color_camera, images.color_width, out);
  checkCamera("depth", images.depth_camera, images.depth_width, out);
  return checkDepth(sensor, out);
}

void checkPose(const SensorReport& sensor, bool on_robot, bool unit_is_right, Findings& out) {
  constexpr double kTiltRad = 0.045, kGapM = 0.05;  // more than the floor of a level flat scatters
  constexpr double kWallsOffM = 0.05, kHandheldM = 0.05, kHandheldRad = 0.05;
  const std::string changes = "the sensor's pose on the robot changes";
  if (sensor.pose_changes && sensor.images)
    out.warning(changes, "objects are seen with that of each record, but the camera's movement is taken for the robot's, as if it "
                         "stood still on it");
  else if (sensor.pose_changes)
    out.note(changes, "each record is used with its own");
  if (!sensor.used || !sensor.robot_from_sensor || !(sensor.images || sensor.scans)) return;
  const bool at_origin = sensor.robot_from_sensor->isApprox(Pose3::Identity(), 1e-9);
  const auto* floor = sensor.images && sensor.images->floor ? &*sensor.images->floor : nullptr;
  const double height_m = sensor.robot_from_sensor->translation().z();
  const std::string option = "--pose " + sensor.label + "=";
  const std::string calibrate = "; 'roomgraph calibrate RAWLOG -o calibration.ini' finds all of it";
  if (sensor.images && sensor.images->walls_off_m && unit_is_right && *sensor.images->walls_off_m > kWallsOffM)
    out.warning(format("walls in the depth images lie %.2f m (median) from where the lidar sees them",
                       *sensor.images->walls_off_m),
                "camera or lidar sits elsewhere than recorded, or their clocks differ" + calibrate);
  if (floor && unit_is_right && (on_robot || mountedHeight(sensor) > kLeastHeightM) &&
      (floor->tilt_rad > kTiltRad || std::abs(floor->sensor_height_m - height_m) > kGapM))
    out.warning(
        format("the floor is seen %.2f m below the sensor and tilted by %.1f deg; by its pose it should "
               "be %.2f m below and level",
               floor->sensor_height_m, floor->tilt_rad * kDegreesPerRadian, height_m),
        "place the sensor, e.g. " + option + formatPose(floor->fitting_pose) +
            " (m, deg), which puts the floor where it belongs" + calibrate);
  else if (const auto& spread = sensor.images ? sensor.images->floor_spread : std::nullopt;
           spread && unit_is_right && !on_robot && mountedHeight(sensor) > kLeastHeightM &&
           (spread->direction_rad > kHandheldRad || spread->height_m > kHandheldM))
    out.warning(format("the camera's pose gives it a height, as on a robot that drives on the floor, but it is held now "
                       "higher, now lower: by %.2f m and %.1f deg (median)",
                       spread->height_m, spread->direction_rad * kDegreesPerRadian),
                "if it is carried by hand, give it no height: " + option + "0,0,0,0,0,0");
  else if (at_origin)
    out.note(on_robot ? "the sensor sits at the robot's origin, looking ahead" : "the camera is taken for handheld",
             "if this is not so, place it" + std::string(on_robot ? "" : " on its robot") + ": " + option +
                 "x,y,z,yaw,pitch,roll (m, deg); heights above the floor "
                 "depend on it");
}

}  // namespace roomgraph
