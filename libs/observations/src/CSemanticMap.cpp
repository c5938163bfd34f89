// SPDX-License-Identifier: BSD-3-Clause
// Serialisation of the semantic map.
#include "roomgraph/observations/CSemanticMap.h"

#include <mrpt/serialization/CArchive.h>
#include <mrpt/serialization/stl_serialization.h>

#include "option_values.h"
#include "roomgraph/observations/growing_reads.h"

namespace roomgraph {
namespace {

using mrpt::serialization::CArchive;

void writePose(CArchive& out, const Pose3& pose) {
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 4; ++j) out << pose.matrix()(i, j);
}

Pose3 readPose(CArchive& in) {
  Pose3 pose = Pose3::Identity();
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 4; ++j) in >> pose.matrix()(i, j);
  return pose;
}

void writeLandmark(CArchive& out, const Landmark& landmark) {
  out << landmark.id.value << landmark.class_name << landmark.model << toString(landmark.shape.kind)
      << landmark.shape.width << landmark.shape.depth << landmark.shape.height;
  for (int i = 0; i < 3; ++i) out << landmark.position[i];
  out << landmark.yaw << landmark.has_yaw;
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) out << landmark.covariance(i, j);
  out << landmark.existence << landmark.class_posterior;
  out.WriteAs<std::int32_t>(landmark.observations);
}

Landmark readLandmark(CArchive& in) {
  Landmark landmark;
  in >> landmark.id.value;
  landmark.class_name = readText(in);
  landmark.model = readText(in);
  landmark.shape.kind = shapeKindFromString(readText(in));
  in >> landmark.shape.width >> landmark.shape.depth >> landmark.shape.height;
  for (int i = 0; i < 3; ++i) in >> landmark.position[i];
  in >> landmark.yaw;
  landmark.has_yaw = in.ReadAs<std::uint8_t>() != 0;  // any byte may be there
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) in >> landmark.covariance(i, j);
  in >> landmark.existence >> landmark.class_posterior;
  landmark.observations = in.ReadAs<std::int32_t>();
  return landmark;
}

StampedPose readStamped(CArchive& in) {
  StampedPose stamped;
  in >> stamped.t;
  stamped.pose = readPose(in);
  return stamped;
}

void writeSeen(CArchive& out, const SeenSpans& seen) {
  out.WriteAs<std::uint32_t>(seen.size());
  for (const auto& [id, span] : seen) out << id.value << span.first << span.last;
}

SeenSpans readSeen(CArchive& in) {
  SeenSpans seen;
  for (auto count = in.ReadAs<std::uint32_t>(); count > 0; --count) {
    LandmarkId id;
    SeenSpan span;
    in >> id.value >> span.first >> span.last;
    seen[id] = span;
  }
  return seen;
}

void writeView(CArchive& out, const KeyView& view) {
  out << view.t;
  writePose(out, view.world_from_camera);
  out.WriteAs<std::uint32_t>(view.corners.size());
  for (const KeyCorner& corner : view.corners) {
    out.WriteBuffer(corner.descriptor.data(), corner.descriptor.size());
    for (const std::int16_t along : corner.place_mm) out << along;
  }
}

KeyCorner readCorner(CArchive& in) {
  KeyCorner corner;
  in.ReadBuffer(corner.descriptor.data(), corner.descriptor.size());
  for (std::int16_t& along : corner.place_mm) in >> along;
  return corner;
}

KeyView readView(CArchive& in) {
  KeyView view;
  in >> view.t;
  view.world_from_camera = readPose(in);
  view.corners = readList(in, readCorner);
  return view;
}

void writeWeights(CArchive& out, const std::map<LandmarkId, double>& weights) {
  out.WriteAs<std::uint32_t>(weights.size());
  for (const auto& [id, weight] : weights) out << id.value << weight;
}

std::map<LandmarkId, double> readWeights(CArchive& in) {
  std::map<LandmarkId, double> weights;
  for (auto count = in.ReadAs<std::uint32_t>(); count > 0; --count) {
    LandmarkId id;
    in >> id.value;
    in >> weights[id];
  }
  return weights;
}

}  // namespace

IMPLEMENTS_SERIALIZABLE(CSemanticMap, mrpt::maps::CMetricMap, roomgraph)

std::uint8_t CSemanticMap::serializeGetVersion() const {
  return 3;
}

void CSemanticMap::serializeTo(CArchive& out) const {
  out << origin << planar << static_cast<bool>(occupancy);
  if (occupancy) out << *occupancy;
  out.WriteAs<std::uint32_t>(landmarks.size());
  for (const auto& landmark : landmarks) writeLandmark(out, landmark);
  out.WriteAs<std::uint32_t>(world_from_robot.size());
  for (const auto& stamped : world_from_robot) {
    out << stamped.t;
    writePose(out, stamped.pose);
  }
  writeSeen(out, seen);
  out << provenance.program << provenance.config << provenance.objects << provenance.history;
  out.WriteAs<std::uint32_t>(views.size());
  for (const auto& view : views) writeView(out, view);
  writeWeights(out, weights);
  out << genericMapParams << valuesOf(insertion) << valuesOf(likelihood);
}

void CSemanticMap::serializeFrom(CArchive& in, std::uint8_t version) {
  if (version > 3) MRPT_THROW_UNKNOWN_SERIALIZATION_VERSION(version);
  in >> origin;
  planar = in.ReadAs<std::uint8_t>() != 0;  // as bytes: in a damaged file they may be neither 0 nor 1
  const bool has_occupancy = in.ReadAs<std::uint8_t>() != 0;
  occupancy.reset();
  if (has_occupancy) {
    occupancy = mrpt::maps::COccupancyGridMap2D::Create();
    in >> *occupancy;
  }
  landmarks = readList(in, readLandmark);
  world_from_robot = readList(in, readStamped);
  seen.clear();
  provenance = {};
  views.clear();
  weights.clear();
  genericMapParams = {};
  insertion = {};
  likelihood = {};
  if (version == 0) return;
  seen = readSeen(in);
  provenance.program = readText(in);
  provenance.config = readText(in);
  provenance.objects = readText(in);
  provenance.history = readList(in, readText);
  if (version == 1) return;
  views = readList(in, readView);
  weights = readWeights(in);
  if (version == 2) return;
  std::map<std::string, std::string> inserting, likely;
  in >> genericMapParams >> inserting >> likely;
  setValues(inserting, insertion);
  setValues(likely, likelihood);
}

}  // namespace roomgraph
