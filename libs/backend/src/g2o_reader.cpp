// SPDX-License-Identifier: BSD-3-Clause
// g2o parser: vertices, edges, landmarks and times, checked for consistency, into a 2D or 3D graph.
#include <Eigen/Cholesky>
#include <cmath>
#include <set>
#include <sstream>

#include "g2o_convention.h"
#include "roomgraph/backend/g2o_file.h"
#include "roomgraph/core/text_file.h"

namespace roomgraph {
namespace {

struct Vertex {
  Pose3 pose = Pose3::Identity();
  double yaw = 0;  // 2D
};

struct Edge {
  int line = 0;
  NodeId a, b;
  Pose3 a_from_b = Pose3::Identity();
  double yaw = 0;               // 2D
  Eigen::MatrixXd information;  // 3x3 or 6x6
};

struct Stamp {
  int line = 0;
  NodeId vertex;
  double t = 0;
};

// Content of a file before its consistency is checked.
struct FileContent {
  std::map<NodeId, Vertex> vertices;
  std::map<NodeId, PlanarLandmark> landmarks;
  std::vector<Stamp> stamps;
  std::vector<std::pair<int, NodeId>> fixed;  // with the line
  std::vector<Edge> edges;
  std::map<std::string, int> skipped;
  bool planar = false, spatial = false;
};

class Reader {
 public:
  explicit Reader(const std::filesystem::path& file) : file_(file) {}

  FileContent read() {
    std::istringstream in(readTextFile(file_));
    for (std::string text; std::getline(in, text);) {
      ++line_;
      words_ = std::istringstream(text);
      if (words_ >> tag_) readLine();
    }
    return std::move(content_);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw InputError(file_.string() + ":" + std::to_string(line_) + ": " + what);
  }

  void readLine() {
    if (tag_ == "VERTEX_SE2") return readVertex(true);
    if (tag_ == "VERTEX_SE3:QUAT") return readVertex(false);
    if (tag_ == "EDGE_SE2") return readEdge(true);
    if (tag_ == "EDGE_SE3:QUAT") return readEdge(false);
    if (tag_ == "FIX") return readFix();
    if (tag_ == "#") return readComment();
    if (!tag_.starts_with("#")) ++content_.skipped[tag_];
  }

  void note(bool planar) {
    (planar ? content_.planar : content_.spatial) = true;
    if (content_.planar && content_.spatial) fail("2D and 3D elements in one file");
  }

  double number(const char* what) {
    double value = 0;
    if (!(words_ >> value) || !std::isfinite(value)) fail(tag_ + ": " + what + " is missing or no number");
    return value;
  }

  NodeId id() {
    std::int64_t value = -1;
    if (!(words_ >> value) || value < 0) fail(tag_ + ": an id is missing or not a whole number from 0 on");
    return NodeId{value};
  }

  void end() {
    if (std::string rest; words_ >> rest) fail(tag_ + ": '" + rest + "' is too much");
  }

  Pose3 pose(bool planar, double& yaw) {
    Eigen::Vector3d t = Eigen::Vector3d::Zero();
    for (int i = 0; i < (planar ? 2 : 3); ++i) t[i] = number("a coordinate");
    Pose3 out = Pose3::Identity();
    out.translation() = t;
    if (planar) {
      yaw = number("the angle");
      return out;
    }
    Eigen::Vector4d q;
    for (double& value : q) value = number("a part of the quaternion");
    if (std::abs(q.norm() - 1) > 0.01) fail(tag_ + ": the quaternion's length is not 1");
    out.linear() = Eigen::Quaterniond(q[3], q[0], q[1], q[2]).normalized().toRotationMatrix();
    return out;
  }

  void readVertex(bool planar) {
    note(planar);
    const NodeId name = id();
    Vertex vertex;
    vertex.pose = pose(planar, vertex.yaw);
    end();
    if (!content_.vertices.emplace(name, vertex).second)
      fail("vertex " + std::to_string(name.value) + " stands in the file twice");
  }

  void readEdge(bool planar) {
    note(planar);
    Edge edge;
    edge.line = line_;
    edge.a = id();
    edge.b = id();
    if (edge.a == edge.b) fail("edge from vertex " + std::to_string(edge.a.value) + " to itself");
    edge.a_from_b = pose(planar, edge.yaw);
    const int size = planar ? 3 : 6;
    edge.information.resize(size, size);
    for (int i = 0; i < size; ++i)
      for (int j = i; j < size; ++j)
        edge.information(i, j) = edge.information(j, i) = number("a number of the information matrix");
    end();
    if (!isInformation(edge)) fail("the information matrix is not positive definite");
    content_.edges.push_back(edge);
  }

  // Factors store covariances: the information must survive inversion and its inverse.
  static bool isInformation(const Edge& edge) {
    const auto definite = [](const Eigen::MatrixXd& matrix) {
      return matrix.allFinite() && Eigen::LLT<Eigen::MatrixXd>(matrix).info() == Eigen::Success;
    };
    if (!definite(edge.information) || edge.information.rows() == 3) return definite(edge.information);
    const Matrix6d covariance = covarianceOfG2o(edge.a_from_b, edge.information);
    return covariance.allFinite() && definite(covariance.inverse());
  }

  void readFix() {
    do {
      content_.fixed.emplace_back(line_, id());
    } while (words_ >> std::ws && !words_.eof());
  }

  // Comments with what the format itself cannot express.
  void readComment() {
    std::string word;
    if (!(words_ >> word)) return;
    tag_ = "# " + word;
    if (word == "STAMP") readStamp();
    if (word == "LANDMARK") readLandmark();
  }

  // "# STAMP vertex t".
  void readStamp() {
    const NodeId vertex = id();
    content_.stamps.push_back({line_, vertex, number("the time")});
    end();
  }

  // "# LANDMARK vertex id shape width depth height".
  void readLandmark() {
    std::string kind;
    const NodeId vertex = id();
    PlanarLandmark name;
    name.id = LandmarkId{id().value};
    words_ >> kind;
    try {
      name.shape.kind = shapeKindFromString(kind);
    } catch (const std::invalid_argument& error) {
      fail(error.what());
    }
    name.shape.width = number("the width");
    name.shape.depth = number("the depth");
    name.shape.height = number("the height");
    end();
    for (const auto& [other, landmark] : content_.landmarks)
      if (other == vertex || landmark.id == name.id)
        fail("landmark " + std::to_string(name.id.value) + " of vertex " + std::to_string(vertex.value) +
             ": that landmark or that vertex was named before");
    content_.landmarks[vertex] = name;
  }

  std::filesystem::path file_;
  int line_ = 0;
  std::string tag_;
  std::istringstream words_;
  FileContent content_;
};

// Checks that every id is defined. Returns the held vertices, at least one, which fixes the gauge.
std::set<NodeId> checked(const FileContent& content, const std::filesystem::path& file) {
  const auto known = [&](int line, NodeId id, const char* what) {
    if (content.vertices.contains(id)) return;
    throw InputError(file.string() + ":" + std::to_string(line) + ": " + what + " vertex " +
                     std::to_string(id.value) + ", which is not in the file");
  };
  if (content.vertices.empty()) throw InputError(file.string() + ": holds no VERTEX_SE2 or VERTEX_SE3:QUAT");
  for (const auto& edge : content.edges) {
    known(edge.line, edge.a, "edge to");
    known(edge.line, edge.b, "edge to");
    if (content.landmarks.contains(edge.a) && !content.landmarks.contains(edge.b))
      throw InputError(file.string() + ":" + std::to_string(edge.line) + ": edge starts at landmark vertex " +
                       std::to_string(edge.a.value));
  }
  for (const auto& [line, vertex, t] : content.stamps) known(line, vertex, "time of");
  for (const auto& [vertex, landmark] : content.landmarks)
    if (!content.vertices.contains(vertex))
      throw InputError(file.string() + ": landmark " + std::to_string(landmark.id.value) + " is vertex " +
                       std::to_string(vertex.value) + ", which is not in the file");
  std::set<NodeId> fixed;
  for (const auto& [line, id] : content.fixed) {
    known(line, id, "FIX of");
    fixed.insert(id);
  }
  if (fixed.empty()) fixed.insert(content.vertices.begin()->first);
  return fixed;
}

PlanarGraph planarGraph(const FileContent& content, const std::set<NodeId>& fixed) {
  const auto flat = [](const Pose3& pose, double yaw) {
    return Pose2{pose.translation().x(), pose.translation().y(), wrapAngle(yaw)};
  };
  PlanarGraph graph;
  graph.fixed = fixed;
  graph.landmarks = content.landmarks;
  for (const auto& [id, vertex] : content.vertices) graph.poses[id] = flat(vertex.pose, vertex.yaw);
  for (const auto& edge : content.edges)
    graph.edges.push_back({edge.a, edge.b, flat(edge.a_from_b, edge.yaw), edge.information});
  return graph;
}

bool measuresYaw(const Edge& edge) {
  return edge.information(5, 5) != kTokenInformation;
}

Eigen::Matrix4d placeCovariance(const Edge& edge) {
  const Matrix6d wide = covarianceOfG2o(edge.a_from_b, edge.information);
  constexpr int kRows[] = {0, 1, 2, 5};
  Eigen::Matrix4d covariance;
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) covariance(i, j) = wide(kRows[i], kRows[j]);
  return covariance;
}

LandmarkFactor sightingOf(const Edge& edge, LandmarkId landmark) {
  LandmarkFactor factor{edge.a, landmark};
  factor.has_yaw = measuresYaw(edge);
  factor.position_in_robot = edge.a_from_b.translation();
  factor.yaw_in_robot = factor.has_yaw ? planarPart(edge.a_from_b).yaw : 0;
  factor.covariance = placeCovariance(edge);
  factor.robust_width = 0;
  return factor;
}

// From a landmark to how it seems from one direction.
LandmarkViewFactor viewOf(const Edge& edge, LandmarkId landmark, LandmarkId view, double yaw) {
  LandmarkViewFactor factor{.view = view, .landmark = landmark};
  factor.offset_m = edge.a_from_b.translation().head<2>();
  factor.has_yaw = measuresYaw(edge);
  factor.covariance = turnedBy(placeCovariance(edge), -yaw);
  factor.robust_width = 0;
  return factor;
}

FactorGraph spatialGraph(const FileContent& content, const std::set<NodeId>& fixed) {
  FactorGraph graph;
  for (const auto& [id, vertex] : content.vertices) {
    const auto landmark = content.landmarks.find(id);
    if (landmark == content.landmarks.end()) {
      graph.addPose(id, vertex.pose, fixed.contains(id));
    } else {
      graph.addLandmark(landmark->second.id,
                        {vertex.pose.translation(), planarPart(vertex.pose).yaw, landmark->second.shape});
    }
  }
  for (const auto& edge : content.edges) {
    const auto from = content.landmarks.find(edge.a), seen = content.landmarks.find(edge.b);
    if (from != content.landmarks.end())
      graph.add(
          viewOf(edge, from->second.id, seen->second.id, planarPart(content.vertices.at(edge.a).pose).yaw));
    else if (seen != content.landmarks.end())
      graph.add(sightingOf(edge, seen->second.id));
    else
      graph.add(
          BetweenFactor{edge.a, edge.b, edge.a_from_b, covarianceOfG2o(edge.a_from_b, edge.information)});
  }
  return graph;
}

}  // namespace

G2oContent loadG2o(const std::filesystem::path& file) {
  FileContent content = Reader(file).read();
  const std::set<NodeId> fixed = checked(content, file);
  G2oContent out{{}, {}, std::move(content.skipped)};
  for (const auto& [line, vertex, t] : content.stamps) out.times[vertex] = t;
  if (content.planar)
    out.graph = planarGraph(content, fixed);
  else
    out.graph = spatialGraph(content, fixed);
  return out;
}

}  // namespace roomgraph
