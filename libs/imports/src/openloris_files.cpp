// SPDX-License-Identifier: BSD-3-Clause
// YAML of OpenCV and whitespace-separated tables.
#include "openloris_files.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <opencv2/core/persistence.hpp>
#include <sstream>

#include "roomgraph/core/errors.h"
#include "roomgraph/core/text_file.h"

namespace roomgraph::openloris {
namespace {

std::vector<double> numbersOf(const cv::FileNode& node) {
  cv::Mat matrix;
  node >> matrix;
  matrix.convertTo(matrix, CV_64F);
  return {matrix.begin<double>(), matrix.end<double>()};
}

// What `read` makes of the file, or why nothing can be made of it.
template <class Value, class Read>
Outcome<Value> readYaml(const std::filesystem::path& file, const Read& read) {
  const std::string name = file.filename().string();
  if (!std::filesystem::is_regular_file(file)) return Outcome<Value>::failure("no " + name);
  try {
    const cv::FileStorage storage(readTextFile(file), cv::FileStorage::READ | cv::FileStorage::MEMORY);
    if (!storage.isOpened()) return Outcome<Value>::failure(name + ": is no YAML of OpenCV");
    const Outcome<Value> value = read(storage);
    return value ? value : Outcome<Value>::failure(name + ": " + value.reason());
  } catch (const std::exception&) {
    return Outcome<Value>::failure(name + ": is no YAML of OpenCV, or damaged");
  }
}

Outcome<PinholeCamera> cameraOf(const cv::FileNode& node, const std::string& name) {
  using Failure = Outcome<PinholeCamera>;
  if (node.empty() || !node.isMap()) return Failure::failure("no " + name);
  const auto k = numbersOf(node["intrinsics"]);
  if (k.size() != 4 || !(k[0] > 0) || !(k[2] > 0) || !std::isfinite(k[0] + k[1] + k[2] + k[3]))
    return Failure::failure(name + " is not calibrated");
  PinholeCamera camera{
      static_cast<int>(node["width"]), static_cast<int>(node["height"]), k[0], k[2], k[1], k[3], {}};
  if (camera.width < 0 || camera.height < 0) return Failure::failure(name + " has no size");
  const auto distortion = node["distortion_coefficients"].empty()
                              ? std::vector<double>()
                              : numbersOf(node["distortion_coefficients"]);
  const bool any = std::any_of(distortion.begin(), distortion.end(), [](double value) { return value != 0; });
  const auto model = static_cast<std::string>(node["distortion_model"]);
  if (any && model != "radial-tangential" && model != "plumb_bob")
    return Failure::failure(name + ": distortion model '" + model + "' is not known");
  if (any && distortion.size() > camera.distortion.size())
    return Failure::failure(name + " has more than 5 distortion coefficients");
  if (any) std::copy(distortion.begin(), distortion.end(), camera.distortion.begin());
  return camera;
}

struct Edge {
  std::string parent;
  Pose3 parent_from_child;
};

Outcome<Pose3> placeOf(const cv::FileNode& list, const std::string& base, const std::string& frame) {
  using Failure = Outcome<Pose3>;
  std::map<std::string, Edge> edges;  // by child
  for (const auto& entry : list) {
    const auto values = numbersOf(entry["matrix"]);
    const auto child = static_cast<std::string>(entry["child_frame"]);
    if (values.size() != 16) return Failure::failure("the matrix of " + child + " is not 4x4");
    Pose3 pose;
    for (Eigen::Index i = 0; i < 16; ++i) pose.matrix()(i / 4, i % 4) = values[static_cast<std::size_t>(i)];
    constexpr double kOff = 1e-2;
    if (!pose.matrix().allFinite() || !(pose.linear() * pose.linear().transpose()).isIdentity(kOff) ||
        pose.linear().determinant() < 0)
      return Failure::failure("the matrix of " + child + " is no transform");
    edges[child] = {static_cast<std::string>(entry["parent_frame"]), normalized(pose)};
  }
  Pose3 place = Pose3::Identity();
  std::string at = frame;
  for (std::size_t steps = 0; at != base; ++steps) {
    const auto edge = edges.find(at);
    if (edge == edges.end() || steps > edges.size())
      return Failure::failure("no transform from " + base + " to " + frame);
    place = edge->second.parent_from_child * place;
    at = edge->second.parent;
  }
  return place;
}

}  // namespace

Outcome<PinholeCamera> readCamera(const std::filesystem::path& file, const std::string& name) {
  return readYaml<PinholeCamera>(
      file, [&](const cv::FileStorage& storage) { return cameraOf(storage[name], name); });
}

Outcome<Pose3> readPlace(const std::filesystem::path& file, const std::string& base,
                         const std::string& frame) {
  return readYaml<Pose3>(
      file, [&](const cv::FileStorage& storage) { return placeOf(storage["trans_matrix"], base, frame); });
}

NumberTable readTable(const std::filesystem::path& file, std::size_t columns) {
  NumberTable table;
  std::istringstream in(readTextFile(file));
  std::string line;
  for (int number = 1; std::getline(in, line); ++number) {
    std::istringstream words(line);
    std::string first;
    if (!(words >> first) || first[0] == '#') continue;
    words = std::istringstream(line);
    std::vector<double> row;
    for (double value = 0; words >> value;) row.push_back(value);
    const bool whole = words.eof() && row.size() >= columns &&
                       std::all_of(row.begin(), row.end(), [](double v) { return std::isfinite(v); });
    if (whole) {
      table.rows.push_back(std::move(row));
    } else if (table.broken++ == 0) {
      table.first_broken = number;
    }
  }
  return table;
}

Outcome<Pose3> poseOfRow(const std::vector<double>& row, std::size_t column) {
  const double* v = row.data() + column;
  const Eigen::Quaterniond q(v[6], v[3], v[4], v[5]);
  if (std::abs(q.norm() - 1) > 0.01) return Outcome<Pose3>::failure("quaternion is not of length 1");
  Pose3 pose = Pose3::Identity();
  pose.linear() = q.normalized().toRotationMatrix();
  pose.translation() = Eigen::Vector3d(v[0], v[1], v[2]);
  return pose;
}

}  // namespace roomgraph::openloris
