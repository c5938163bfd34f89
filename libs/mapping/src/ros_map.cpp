// SPDX-License-Identifier: BSD-3-Clause
// ROS map_server files: PGM image and YAML, written and read.
#include <yaml-cpp/yaml.h>

#include <cmath>
#include <opencv2/imgcodecs.hpp>
#include <sstream>
#include <stdexcept>
#include <vector>

#include "roomgraph/core/output_file.h"
#include "roomgraph/core/text_file.h"
#include "roomgraph/geometry/plausible_pose.h"
#include "roomgraph/mapping/map_files.h"
#include "roomgraph/observations/image_file.h"

namespace roomgraph {
namespace {

constexpr double kOccupiedThreshold = 0.65, kFreeThreshold = 0.196;  // map_server's usual values
constexpr unsigned char kFree = 254, kOccupied = 0, kUnknown = 205;

unsigned char grayOf(double p_free) {
  if (1 - p_free > kOccupiedThreshold) return kOccupied;
  return 1 - p_free < kFreeThreshold ? kFree : kUnknown;
}

struct RosMap {
  std::filesystem::path image;
  double resolution_m = 0, x_min = 0, y_min = 0;
  double occupied_threshold = 0, free_threshold = 0;
  bool negate = false;
};

// MRPT's reader is not used: it prints messages about a broken file.
template <class T>
T valueOf(const YAML::Node& yaml, const char* key) {
  if (!yaml[key]) throw std::runtime_error(std::string("'") + key + "' is missing");
  try {
    return yaml[key].as<T>();
  } catch (const YAML::Exception& error) {
    throw std::runtime_error(std::string("'") + key + "': " + error.what());
  }
}

RosMap readYaml(const std::filesystem::path& file) {
  const std::string text = readTextFile(file);
  try {
    const YAML::Node yaml = YAML::Load(text);
    if (!yaml.IsMap()) throw std::runtime_error("holds no keys");
    RosMap map;
    map.image = valueOf<std::string>(yaml, "image");
    if (map.image.is_relative()) map.image = file.parent_path() / map.image;
    map.resolution_m = valueOf<double>(yaml, "resolution");
    const auto origin = valueOf<std::vector<double>>(yaml, "origin");
    if (origin.size() < 2) throw std::runtime_error("'origin' is not [x, y, yaw]");
    if (origin.size() > 2 && origin[2] != 0) throw std::runtime_error("a rotated 'origin' is not supported");
    map.x_min = origin[0];
    map.y_min = origin[1];
    map.occupied_threshold = valueOf<double>(yaml, "occupied_thresh");
    map.free_threshold = valueOf<double>(yaml, "free_thresh");
    map.negate = yaml["negate"] && valueOf<int>(yaml, "negate") != 0;
    if (!(map.resolution_m > 1e-4) || !(map.resolution_m < 100))
      throw std::runtime_error("'resolution' is not in (0.0001, 100) m");
    if (!(std::abs(map.x_min) < kFarthest_m) || !(std::abs(map.y_min) < kFarthest_m))
      throw std::runtime_error("'origin' is too far away");
    return map;
  } catch (const std::exception& error) {
    throw InputError(file.string() + ": not a map_server yaml: " + firstLine(error));
  }
}

}  // namespace

void saveOccupancyRos(const mrpt::maps::COccupancyGridMap2D& grid, const std::filesystem::path& stem) {
  auto pgm = stem, yaml = stem;
  pgm += ".pgm";
  yaml += ".yaml";
  const unsigned width = grid.getSizeX(), height = grid.getSizeY();
  std::string image = "P5\n" + std::to_string(width) + " " + std::to_string(height) + "\n255\n";
  image.reserve(image.size() + std::size_t{width} * height);
  // Images start at the top left: the row of the largest y comes first.
  for (int y = static_cast<int>(height) - 1; y >= 0; --y)
    for (int x = 0; x < static_cast<int>(width); ++x)
      image.push_back(static_cast<char>(grayOf(static_cast<double>(grid.getCell(x, y)))));
  std::ostringstream text;
  text << "image: " << pgm.filename().string() << "\nresolution: " << grid.getResolution() << "\norigin: ["
       << grid.getXMin() << ", " << grid.getYMin()
       << ", 0.0]\nnegate: 0\noccupied_thresh: " << kOccupiedThreshold << "\nfree_thresh: " << kFreeThreshold
       << "\nmode: trinary\n";
  writeFileAtomically(pgm, image);
  writeFileAtomically(yaml, text.str());
}

PlacedGrid loadOccupancyRos(const std::filesystem::path& yaml) {
  const RosMap map = readYaml(yaml);
  const cv::Mat image = readImageFile(map.image, cv::IMREAD_GRAYSCALE);
  if (image.empty()) throw InputError(yaml.string() + ": image " + map.image.string() + " cannot be read");
  PlacedGrid out{{}, {map.x_min, map.y_min}};
  auto& grid = out.grid;
  try {
    grid.setSize(0, static_cast<float>(image.cols * map.resolution_m), 0, static_cast<float>(image.rows * map.resolution_m),
                 static_cast<float>(map.resolution_m));
  } catch (const std::exception& error) {  // too small for the digits of a float
    throw InputError(yaml.string() + ": 'resolution' does not fit: " + firstLine(error));
  }
  for (int v = 0; v < image.rows; ++v) {
    for (int u = 0; u < image.cols; ++u) {
      const int gray = image.at<unsigned char>(v, u);
      const double p_occupied = (map.negate ? gray : 255 - gray) / 255.0;
      const float p_free = p_occupied > map.occupied_threshold ? 0.f
                           : p_occupied < map.free_threshold   ? 1.f
                                                               : 0.5f;
      grid.setCell(u, image.rows - 1 - v, p_free);
    }
  }
  return out;
}

}  // namespace roomgraph
