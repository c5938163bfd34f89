// SPDX-License-Identifier: BSD-3-Clause
// The semantic map as MRPT uses maps: insertion, likelihood, matching, files.
#include <mrpt/core/Clock.h>
#include <mrpt/opengl/COpenGLScene.h>

#include <cerrno>

#include "box_insertion.h"
#include "box_likelihood.h"
#include "detection_boxes.h"
#include "empty_grid.h"
#include "roomgraph/core/output_file.h"
#include "roomgraph/observations/map_file.h"

namespace roomgraph {
namespace {

using mrpt::maps::COccupancyGridMap2D;

Pose3 poseOrOrigin(const std::optional<const mrpt::poses::CPose3D>& pose) {
  return pose ? toPose3(*pose) : Pose3::Identity();
}

PinholeCamera cameraOf(const CObservationDetections& detections, const MapLikelihoodOptions& options) {
  return options.cameraOf(static_cast<int>(detections.image_width),
                          static_cast<int>(detections.image_height));
}

void insertDetections(const CObservationDetections& detections, const Pose3& world_from_camera,
                      const PinholeCamera& camera, const ObjectDatabase& database, CSemanticMap& map) {
  const double t = mrpt::Clock::toDouble(detections.timestamp);
  for (const auto& item : detections.items) {
    const ObjectModel* model = database.byLabel(item.label);
    if (!model || !model->landmark) continue;
    const Box2 box{item.u_min, item.v_min, item.u_max, item.v_max};
    const auto sighting = placedByBox(box, *model, camera, world_from_camera, map.likelihood);
    if (!sighting) continue;
    const auto id = insertSighting(*sighting, item.score, map.insertion, map.landmarks);
    if (!id) continue;
    const auto [span, first] = map.seen.try_emplace(*id, SeenSpan{t, t});
    span->second.first = std::min(span->second.first, t);
    span->second.last = std::max(span->second.last, t);
  }
}

void saveObjectsText(const std::vector<Landmark>& landmarks, const std::string& file) {
  OutputFile out(file);
  out << "% id class x y z yaw width depth height existence observations (m, rad)\n";
  for (const Landmark& landmark : landmarks)
    out << landmark.id << " " << landmark.class_name << " " << landmark.position.x() << " "
        << landmark.position.y() << " " << landmark.position.z() << " " << landmark.yaw << " "
        << landmark.shape.width << " " << landmark.shape.depth << " " << landmark.shape.height << " "
        << landmark.existence << " " << landmark.observations << "\n";
  out.finish();
}

}  // namespace

bool CSemanticMap::isEmpty() const {
  return landmarks.empty() && (!occupancy || occupancy->isEmpty());
}

std::string CSemanticMap::asString() const {
  std::string text = "semantic map of " + std::to_string(landmarks.size()) + " objects";
  if (occupancy)
    text += " and " + std::to_string(occupancy->getSizeX()) + " x " + std::to_string(occupancy->getSizeY()) +
            " cells";
  return text;
}

void CSemanticMap::internal_clear() {
  if (occupancy) {
    // A grid of the same options: those of an ini outlive the content.
    auto empty = COccupancyGridMap2D::Create(*occupancy);
    empty->clear();
    occupancy = empty;
  }
  landmarks.clear();
  world_from_robot.clear();
  seen.clear();
  views.clear();
  weights.clear();
  origin.clear();
}

bool CSemanticMap::insertIntoGrid(const mrpt::obs::CObservation& observation,
                                  const std::optional<const mrpt::poses::CPose3D>& robot_pose) {
  auto grid = occupancy;
  if (!grid) grid = emptyGrid(insertion.grid_resolution_m);
  if (occupancy.use_count() > 2) grid = COccupancyGridMap2D::Create(*grid);  // a copy of this map has it, too
  if (!grid->insertObservation(observation, robot_pose)) return false;
  occupancy = grid;
  return true;
}

bool CSemanticMap::internal_insertObservation(const mrpt::obs::CObservation& observation,
                                              const std::optional<const mrpt::poses::CPose3D>& robot_pose) {
  bool changed = false;
  if (const auto detections = detectionsIn(observation)) {
    const auto database = databaseOf(*this);
    const PinholeCamera camera = cameraOf(*detections, likelihood);
    if (!insertion.insert_objects || !database || !camera.valid()) return false;
    insertDetections(*detections, poseOrOrigin(robot_pose) * likelihood.robotFromCamera(), camera, *database,
                     *this);
    changed = true;
  } else {
    changed = insertIntoGrid(observation, robot_pose);
  }
  const double t = mrpt::Clock::toDouble(observation.timestamp);
  if (changed && robot_pose && (world_from_robot.empty() || t > world_from_robot.back().t))
    world_from_robot.push_back({t, toPose3(*robot_pose)});
  return changed;
}

bool CSemanticMap::internal_canComputeObservationLikelihood(
    const mrpt::obs::CObservation& observation) const {
  if (const auto detections = detectionsIn(observation))
    return likelihood.use_objects && !landmarks.empty() && cameraOf(*detections, likelihood).valid();
  return likelihood.use_grid && occupancy && occupancy->canComputeObservationLikelihood(observation);
}

double CSemanticMap::internal_computeObservationLikelihood(const mrpt::obs::CObservation& observation,
                                                           const mrpt::poses::CPose3D& robot_pose) const {
  if (!internal_canComputeObservationLikelihood(observation)) return 0;
  const auto detections = detectionsIn(observation);
  if (!detections) return occupancy->computeObservationLikelihood(observation, robot_pose);
  const PinholeCamera camera = cameraOf(*detections, likelihood);
  const auto database = databaseOf(*this);
  const Pose3 world_from_camera = toPose3(robot_pose) * likelihood.robotFromCamera();
  const auto expected = expectedBoxes(landmarks, occupancy.get(), world_from_camera, camera, likelihood);
  return likelihood.tempering * logLikelihoodOf(boxesOfLandmarks(*detections, database.get()), expected,
                                                camera, labelCount(*this, database.get()), likelihood);
}

void CSemanticMap::determineMatching2D(const mrpt::maps::CMetricMap* other,
                                       const mrpt::poses::CPose2D& other_pose,
                                       mrpt::tfest::TMatchingPairList& correspondences,
                                       const mrpt::maps::TMatchingParams& params,
                                       mrpt::maps::TMatchingExtraResults& extra) const {
  correspondences.clear();
  extra = {};
  if (occupancy) occupancy->determineMatching2D(other, other_pose, correspondences, params, extra);
}

float CSemanticMap::compute3DMatchingRatio(const mrpt::maps::CMetricMap* other,
                                           const mrpt::poses::CPose3D& other_pose,
                                           const mrpt::maps::TMatchingRatioParams& params) const {
  return occupancy ? occupancy->compute3DMatchingRatio(other, other_pose, params) : 0;
}

void CSemanticMap::saveMetricMapRepresentationToFile(const std::string& prefix) const {
  saveMap(*this, prefix + ".rgmap");
  saveObjectsText(landmarks, prefix + "_objects.txt");
  if (occupancy) occupancy->saveMetricMapRepresentationToFile(prefix + "_grid");
  mrpt::opengl::COpenGLScene scene;
  scene.insert(getVisualization());
  if (!scene.saveToFile(prefix + ".3Dscene")) failToWrite(prefix + ".3Dscene", errno);
}

}  // namespace roomgraph
