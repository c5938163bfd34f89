// SPDX-License-Identifier: BSD-3-Clause
// Field lists of ROS messages, joined to the definitions that bags carry.
#include "message_types.h"

#include <map>
#include <vector>

namespace roomgraph::bags {
namespace {

const std::map<std::string, std::string>& fieldLists() {
  static const std::map<std::string, std::string> lists{
      {"std_msgs/Header", "uint32 seq\ntime stamp\nstring frame_id\n"},
      {"std_msgs/ColorRGBA", "float32 r\nfloat32 g\nfloat32 b\nfloat32 a\n"},
      {"geometry_msgs/Point", "float64 x\nfloat64 y\nfloat64 z\n"},
      {"geometry_msgs/Vector3", "float64 x\nfloat64 y\nfloat64 z\n"},
      {"geometry_msgs/Quaternion", "float64 x\nfloat64 y\nfloat64 z\nfloat64 w\n"},
      {"geometry_msgs/Pose", "Point position\nQuaternion orientation\n"},
      {"geometry_msgs/PoseStamped", "Header header\nPose pose\n"},
      {"geometry_msgs/PoseWithCovariance", "Pose pose\nfloat64[36] covariance\n"},
      {"geometry_msgs/Twist", "Vector3 linear\nVector3 angular\n"},
      {"geometry_msgs/TwistWithCovariance", "Twist twist\nfloat64[36] covariance\n"},
      {"geometry_msgs/Transform", "Vector3 translation\nQuaternion rotation\n"},
      {"geometry_msgs/TransformStamped", "Header header\nstring child_frame_id\nTransform transform\n"},
      {"tf2_msgs/TFMessage", "geometry_msgs/TransformStamped[] transforms\n"},
      {"sensor_msgs/Image",
       "Header header\nuint32 height\nuint32 width\nstring encoding\nuint8 is_bigendian\nuint32 "
       "step\nuint8[] data\n"},
      {"sensor_msgs/RegionOfInterest",
       "uint32 x_offset\nuint32 y_offset\nuint32 height\nuint32 width\nbool do_rectify\n"},
      {"sensor_msgs/CameraInfo",
       "Header header\nuint32 height\nuint32 width\nstring distortion_model\nfloat64[] D\nfloat64[9] "
       "K\nfloat64[9] R\n"
       "float64[12] P\nuint32 binning_x\nuint32 binning_y\nRegionOfInterest roi\n"},
      {"sensor_msgs/LaserScan",
       "Header header\nfloat32 angle_min\nfloat32 angle_max\nfloat32 angle_increment\nfloat32 "
       "time_increment\n"
       "float32 scan_time\nfloat32 range_min\nfloat32 range_max\nfloat32[] ranges\nfloat32[] intensities\n"},
      {"sensor_msgs/Imu",
       "Header header\ngeometry_msgs/Quaternion orientation\nfloat64[9] orientation_covariance\n"
       "geometry_msgs/Vector3 angular_velocity\nfloat64[9] angular_velocity_covariance\n"
       "geometry_msgs/Vector3 linear_acceleration\nfloat64[9] linear_acceleration_covariance\n"},
      {"nav_msgs/Odometry",
       "Header header\nstring child_frame_id\ngeometry_msgs/PoseWithCovariance pose\n"
       "geometry_msgs/TwistWithCovariance twist\n"},
      {"nav_msgs/Path", "Header header\ngeometry_msgs/PoseStamped[] poses\n"},
      {"nav_msgs/MapMetaData",
       "time map_load_time\nfloat32 resolution\nuint32 width\nuint32 height\ngeometry_msgs/Pose origin\n"},
      {"nav_msgs/OccupancyGrid", "Header header\nMapMetaData info\nint8[] data\n"},
      {"visualization_msgs/Marker",
       "uint8 ARROW=0\nuint8 CUBE=1\nuint8 SPHERE=2\nuint8 CYLINDER=3\nuint8 LINE_STRIP=4\nuint8 "
       "LINE_LIST=5\n"
       "uint8 CUBE_LIST=6\nuint8 SPHERE_LIST=7\nuint8 POINTS=8\nuint8 TEXT_VIEW_FACING=9\nuint8 "
       "MESH_RESOURCE=10\n"
       "uint8 TRIANGLE_LIST=11\nuint8 ADD=0\nuint8 MODIFY=0\nuint8 DELETE=2\nuint8 DELETEALL=3\n"
       "Header header\nstring ns\nint32 id\nint32 type\nint32 action\ngeometry_msgs/Pose pose\n"
       "geometry_msgs/Vector3 scale\nstd_msgs/ColorRGBA color\nduration lifetime\nbool frame_locked\n"
       "geometry_msgs/Point[] points\nstd_msgs/ColorRGBA[] colors\nstring text\nstring mesh_resource\n"
       "bool mesh_use_embedded_materials\n"},
      {"visualization_msgs/MarkerArray", "Marker[] markers\n"},
  };
  return lists;
}

const std::vector<std::string> kPose{"geometry_msgs/Pose", "geometry_msgs/Point", "geometry_msgs/Quaternion"};

MessageType typeWith(const std::string& name, const std::string& md5, std::vector<std::string> parts,
                     bool with_pose = false) {
  if (with_pose) parts.insert(parts.end(), kPose.begin(), kPose.end());
  std::string definition = fieldLists().at(name);
  for (const auto& part : parts)
    definition += std::string(80, '=') + "\nMSG: " + part + "\n" + fieldLists().at(part);
  return {name, md5, definition};
}

std::map<std::string, MessageType> allTypes() {
  const std::string header = "std_msgs/Header";
  std::map<std::string, MessageType> types;
  for (auto& type : {
           typeWith("sensor_msgs/Image", "060021388200f6f0f447d0fcd9c64743", {header}),
           typeWith("sensor_msgs/CameraInfo", "c9a58c1b0b154e0e6da7578cb991d214",
                    {header, "sensor_msgs/RegionOfInterest"}),
           typeWith("sensor_msgs/LaserScan", "90c7ef2dc6895d81024acba2ac42f369", {header}),
           typeWith("sensor_msgs/Imu", "6a62c6daae103f4ff57a132d6f95cec2",
                    {header, "geometry_msgs/Quaternion", "geometry_msgs/Vector3"}),
           typeWith("nav_msgs/Odometry", "cd5e73d190d741a2f92e81eda573aca7",
                    {header, "geometry_msgs/PoseWithCovariance", "geometry_msgs/TwistWithCovariance",
                     "geometry_msgs/Twist", "geometry_msgs/Vector3"},
                    true),
           typeWith("geometry_msgs/PoseStamped", "d3812c3cbc69362b77dc0b19b345f8f5", {header}, true),
           typeWith("tf2_msgs/TFMessage", "94810edda583a504dfda3829e70d7eec",
                    {"geometry_msgs/TransformStamped", header, "geometry_msgs/Transform",
                     "geometry_msgs/Vector3", "geometry_msgs/Quaternion"}),
           typeWith("nav_msgs/OccupancyGrid", "3381f2d731d4076ec5c71b0759edbe4e",
                    {header, "nav_msgs/MapMetaData"}, true),
           typeWith("nav_msgs/Path", "6227e2b7e9cce15051f669a5e197bbf7",
                    {header, "geometry_msgs/PoseStamped"}, true),
           typeWith("visualization_msgs/MarkerArray", "d155b9ce5188fbaf89745847fd5882d7",
                    {"visualization_msgs/Marker", header, "geometry_msgs/Vector3", "std_msgs/ColorRGBA"},
                    true),
       })
    types.emplace(type.name, type);
  return types;
}

}  // namespace

const MessageType& messageType(const std::string& name) {
  static const auto types = allTypes();
  return types.at(name);
}

}  // namespace roomgraph::bags
