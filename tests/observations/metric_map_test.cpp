// SPDX-License-Identifier: BSD-3-Clause
// The semantic map as MRPT uses it: ini, insertion, likelihood, drawing, files.
#include <gmock/gmock.h>
#include <mrpt/config/CConfigFileMemory.h>
#include <mrpt/io/CMemoryStream.h>
#include <mrpt/maps/CMultiMetricMap.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/opengl/COpenGLScene.h>
#include <mrpt/serialization/CArchive.h>

#include <cmath>

#include "box_likelihood.h"
#include "errors_of.h"
#include "option_values.h"
#include "room_scan.h"
#include "roomgraph/core/errors.h"
#include "roomgraph/core/text_file.h"
#include "roomgraph/observations/CObservationDetections.h"
#include "roomgraph/observations/detection_comment.h"
#include "roomgraph/observations/map_file.h"
#include "roomgraph/observations/register_classes.h"
#include "sample_map.h"
#include "temporary_folder.h"

namespace roomgraph {
namespace {

using mrpt::maps::CMultiMetricMap;
using mrpt::poses::CPose3D;
using test::messageOf;
using ::testing::HasSubstr;

const char* const kChairsOnly =
    "[swivel_chair]\nlabels = chair\nshape = cylinder\nwidth_m = 0.7\ndepth_m = 0.7\nheight_m = 0.9\n"
    "[sofa]\nlabels = couch\nshape = cuboid\nwidth_m = 1.6\ndepth_m = 0.8\nheight_m = 0.8\n"
    "[person]\nlabels = person\nmoves = true\nlandmark = false\n";

const char* const kCameraKeys =
    "camera_width = 320\ncamera_height = 240\ncamera_fx = 262.5\ncamera_fy = 262.5\ncamera_cx = 159.5\n"
    "camera_cy = 119.5\ncamera_x = 0.05\ncamera_z = 0.8\ncamera_pitch_deg = 12 // down\n";

CMultiMetricMap fromIni(const std::string& text) {
  observations::registerClasses();
  mrpt::config::CConfigFileMemory ini(text);
  mrpt::maps::TSetOfMetricMapInitializers initializers;
  initializers.loadFromConfigFile(ini, "Map");
  CMultiMetricMap maps;
  maps.setListOfMaps(initializers);
  return maps;
}

CSemanticMap mapWithCamera() {
  CSemanticMap map = test::sampleMap();
  for (Landmark& landmark : map.landmarks) {
    landmark.covariance = Eigen::Matrix4d::Identity() * 1e-4;
    landmark.class_posterior = {{landmark.class_name, 1}};
  }
  map.provenance.objects = kChairsOnly;
  MapLikelihoodOptions& o = map.likelihood;
  o.camera_width = 320;
  o.camera_height = 240;
  o.camera_fx = o.camera_fy = 262.5;
  o.camera_cx = 159.5;
  o.camera_cy = 119.5;
  o.camera_z = 0.8;
  o.camera_pitch_deg = 12;
  return map;
}

/// What a faultless detector sees of the map's objects.
CObservationDetections seenFrom(const CSemanticMap& map, const CPose3D& robot) {
  CObservationDetections out;
  out.timestamp = mrpt::Clock::fromDouble(1700000000);
  out.image_width = 320;
  out.image_height = 240;
  const PinholeCamera camera = map.likelihood.cameraOf(320, 240);
  for (const auto& seen :
       expectedBoxes(map.landmarks, nullptr, toPose3(robot) * map.likelihood.robotFromCamera(), camera,
                     map.likelihood)) {
    const Box2 box = clipped(seen.bounds, 320, 240);
    const std::string name = seen.landmark->class_name;
    const std::string label = name == "swivel_chair" ? "chair" : name == "sofa" ? "couch" : name;
    out.items.push_back({label, 0.9, box.u_min, box.v_min, box.u_max, box.v_max, -1, {}});
  }
  return out;
}

std::string bytesOfMap(const CSemanticMap& map) {
  mrpt::io::CMemoryStream memory;
  auto archive = mrpt::serialization::archiveFrom(memory);
  archive << map;
  return {static_cast<const char*>(memory.getRawBufferData()),
          static_cast<std::size_t>(memory.getTotalBytesCount())};
}

// MRPT wraps what is thrown while it makes maps into an exception of its own, with the same words.
template <class Action>
std::string wrappedMessageOf(Action&& action) {
  try {
    action();
  } catch (const std::exception& error) {
    return error.what();
  }
  return "";
}

TEST(MetricMap, MultiMapsMakeItFromAnIni) {
  const test::TemporaryFolder folder;
  saveMap(test::sampleMap(), folder.file("room.rgmap"));
  const auto maps = fromIni(
      "[Map]\nsemanticMap_count = 1\noccupancyGrid_count = 1\n[Map_semanticMap_00_creationOpts]\nfile = " +
      folder.file("room.rgmap").string() +
      "\nenableObservationInsertion = false\n[Map_semanticMap_00_likelihoodOpts]\nbox_sigma = 0.25 ; "
      "of a side\nLF_decimation = 7\n" +
      kCameraKeys + "[Map_semanticMap_00_insertOpts]\ngate_sigma = 4\nmaxDistanceInsertion = 3\n");
  ASSERT_EQ(maps.maps.size(), 2U);
  const auto map = maps.mapByClass<CSemanticMap>();
  ASSERT_TRUE(map);
  EXPECT_EQ(map->landmarks.size(), 3U);
  EXPECT_FALSE(map->genericMapParams.enableObservationInsertion);
  EXPECT_EQ(map->likelihood.box_sigma, 0.25);
  EXPECT_EQ(map->likelihood.camera_pitch_deg, 12);
  EXPECT_EQ(map->insertion.gate_sigma, 4);
  EXPECT_EQ(map->occupancy->likelihoodOptions.LF_decimation, 7U);
  EXPECT_EQ(map->occupancy->insertionOptions.maxDistanceInsertion, 3);
  EXPECT_TRUE(maps.mapByClass<mrpt::maps::COccupancyGridMap2D>());
  EXPECT_TRUE(fromIni("[Map]\nroomgraph::CSemanticMap_count = 1\n").mapByClass<CSemanticMap>())
      << "by the class' name";
  EXPECT_TRUE(fromIni("[Map]\nsemanticMap_count = 1\n").mapByClass<CSemanticMap>()->isEmpty());
}

TEST(MetricMap, BadIniNamesSectionAndKey) {
  const auto error = [](const std::string& text) { return wrappedMessageOf([&] { fromIni(text); }); };
  EXPECT_THAT(error("[Map]\nsemanticMap_count = 1\n[Map_semanticMap_00_likelihoodOpts]\nhidden_side = 2\n"),
              ::testing::AllOf(HasSubstr("section Map_semanticMap_00_likelihoodOpts, hidden_side = 2"),
                               HasSubstr("a number in [0, 1")));
  EXPECT_THAT(error("[Map]\nsemanticMap_count = 1\n[Map_semanticMap_00_insertOpts]\ngate_sigma = wide\n"),
              HasSubstr("gate_sigma = wide"));
  EXPECT_THAT(
      wrappedMessageOf([] {
        fromIni("[Map]\nsemanticMap_count = 1\n[Map_semanticMap_00_creationOpts]\nfile = none.rgmap\n");
      }),
      HasSubstr("none.rgmap: no such file"));
}

TEST(MetricMap, KeysAreDocumented) {
  const std::string page = readTextFile(ROOMGRAPH_SOURCE_DIR "/docs/mrpt.md");
  for (const auto& values : {valuesOf(MapInsertionOptions()), valuesOf(MapLikelihoodOptions())})
    for (const auto& [key, value] : values) {
      EXPECT_THAT(page, HasSubstr("`" + key + "`"));
      if (key.starts_with("camera_") || value == "true") continue;
      EXPECT_THAT(page, HasSubstr("`" + key + "` (" + value + ")")) << "the default";
    }
}

TEST(MetricMap, EmptyMapsGetTheirClasses) {
  const std::string objects = ROOMGRAPH_SOURCE_DIR "/objects.ini";
  const auto begun = [](const std::string& file) {
    return fromIni("[Map]\nsemanticMap_count = 1\n[Map_semanticMap_00_creationOpts]\nobjects_file = " + file +
                   "\n")
        .mapByClass<CSemanticMap>();
  };
  EXPECT_EQ(begun(objects)->provenance.objects, readTextFile(objects));
  EXPECT_THAT(wrappedMessageOf([&] { begun("none.ini"); }), HasSubstr("none.ini"));
}

TEST(MetricMap, ScansAreAskedOfTheGrid) {
  CSemanticMap map = test::sampleMap();
  const auto scan = test::scanOfRoom(2.95, 1.95);
  EXPECT_TRUE(map.canComputeObservationLikelihood(scan));
  for (const auto& [x, yaw] : {std::pair{2.0, 0.0}, {2.5, 0.4}})
    EXPECT_EQ(map.computeObservationLikelihood(scan, CPose3D(x, 0, 0, yaw, 0, 0)),
              map.occupancy->computeObservationLikelihood(scan, CPose3D(x, 0, 0, yaw, 0, 0)));
  EXPECT_GT(map.computeObservationLikelihood(scan, CPose3D(2, 0, 0, 0, 0, 0)),
            map.computeObservationLikelihood(scan, CPose3D(2.5, 0, 0, 0.4, 0, 0)));
  map.likelihood.use_grid = false;
  EXPECT_FALSE(map.canComputeObservationLikelihood(scan));
  EXPECT_EQ(map.computeObservationLikelihood(scan, CPose3D()), 0);
}

TEST(MetricMap, DetectionsTellThePose) {
  const CSemanticMap map = mapWithCamera();
  const CPose3D truth(-0.6, 0.5, 0, -0.1, 0, 0);
  const auto seen = seenFrom(map, truth);
  ASSERT_GE(seen.items.size(), 2U);
  ASSERT_TRUE(map.canComputeObservationLikelihood(seen));
  const double best = map.computeObservationLikelihood(seen, truth);
  for (const auto& [x, y, yaw] : {std::array{0.5, 0., 0.},
                                  {-0.5, 0., 0.},
                                  {0., 0.4, 0.},
                                  {0., -0.4, 0.},
                                  {0., 0., 0.2},
                                  {0., 0., -0.2}})
    EXPECT_GT(best, map.computeObservationLikelihood(seen, truth + CPose3D(x, y, 0, yaw, 0, 0)) + 1);
  auto with_person = seen;
  with_person.items.push_back({"person", 0.9, 10, 20, 60, 200, -1, {}});
  with_person.items.push_back({"zebra", 0.9, 10, 20, 60, 200, -1, {}});
  EXPECT_EQ(map.computeObservationLikelihood(with_person, truth), best)
      << "no landmarks, no word about the pose";
  auto swapped = seen;
  for (auto& item : swapped.items) item.label = item.label == "chair" ? "couch" : "chair";
  EXPECT_LT(map.computeObservationLikelihood(swapped, truth), best - 2) << "labels count";
}

// The formula of method.md sec. 6.1 for one landmark and one box, with the density of the box from elsewhere.
TEST(MetricMap, OptionsOfTheLikelihoodAreUsed) {
  CSemanticMap map = mapWithCamera();
  map.landmarks.resize(1);
  map.occupancy.reset();
  const CPose3D robot(-1, 1, 0, 0, 0, 0);
  const auto seen = seenFrom(map, robot);
  ASSERT_EQ(seen.items.size(), 1U);
  map.likelihood.tempering = 0.3;
  map.likelihood.clutter_boxes = 0.7;
  const PinholeCamera camera = map.likelihood.cameraOf(320, 240);
  const auto expected = expectedBoxes(
      map.landmarks, nullptr, toPose3(robot) * map.likelihood.robotFromCamera(), camera, map.likelihood)[0];
  const auto& item = seen.items[0];
  const Box2 box{item.u_min, item.v_min, item.u_max, item.v_max};
  const double label = 0.95 + 0.05 / 2;  // two classes of landmarks: chair and sofa
  const double sum = 0.7 / 2 * clutterDensity(box, camera) +
                     expected.count * label * boxDensityOf(box, expected, camera, 0.2);
  EXPECT_NEAR(map.computeObservationLikelihood(seen, robot), 0.3 * (std::log(sum) - expected.count), 1e-9);
  map.genericMapParams.enableObservationLikelihood = false;
  EXPECT_FALSE(map.canComputeObservationLikelihood(seen));
}

TEST(MetricMap, CommentsAreDetectionsToo) {
  const CSemanticMap map = mapWithCamera();
  const CPose3D robot(-0.6, 0.5, 0, -0.1, 0, 0);
  for (const CPose3D& seen_from : {robot, CPose3D(0, 0, 0, 0.1, 0, 0)}) {
    const auto seen = seenFrom(map, seen_from);
    EXPECT_TRUE(map.canComputeObservationLikelihood(toComment(seen)));
    EXPECT_EQ(map.computeObservationLikelihood(toComment(seen), robot),
              map.computeObservationLikelihood(seen, robot));
  }
  mrpt::obs::CObservationComment other;
  other.text = "a remark";
  EXPECT_FALSE(map.canComputeObservationLikelihood(other));
}

TEST(MetricMap, CamerasOfAnotherShapeAreUnknown) {
  CSemanticMap map = mapWithCamera();
  auto seen = seenFrom(map, CPose3D());
  EXPECT_TRUE(map.canComputeObservationLikelihood(seen));
  seen.image_width = 640;
  EXPECT_FALSE(map.canComputeObservationLikelihood(seen)) << "640 x 240";
  seen.image_height = 480;
  EXPECT_TRUE(map.canComputeObservationLikelihood(seen)) << "the same camera, twice as fine";
  EXPECT_NEAR(map.likelihood.cameraOf(640, 480).fx, 525, 1e-9);
  map.likelihood.camera_fx = 0;
  EXPECT_FALSE(map.canComputeObservationLikelihood(seen));
}

TEST(MetricMap, EqualAfterSerialisation) {
  CSemanticMap map = mapWithCamera();
  const auto seen = seenFrom(map, CPose3D(-0.6, 0.5, 0, -0.1, 0, 0));
  map.likelihood.hidden_side = 1 / 3.0;
  map.occupancy->likelihoodOptions.LF_stdHit = 0.125F;
  CMultiMetricMap maps, back;
  maps.maps.push_back(std::make_shared<CSemanticMap>(map));
  mrpt::io::CMemoryStream memory;
  auto archive = mrpt::serialization::archiveFrom(memory);
  archive << maps;
  memory.Seek(0);
  archive >> back;
  const auto again = back.mapByClass<CSemanticMap>();
  ASSERT_TRUE(again);
  EXPECT_EQ(bytesOfMap(*again), bytesOfMap(map));
  const CPose3D robot(-0.5, 0.4, 0, 0, 0, 0);
  EXPECT_EQ(back.computeObservationLikelihood(seen, robot), map.computeObservationLikelihood(seen, robot));
  const auto scan = test::scanOfRoom(2.9, 1.9);
  EXPECT_EQ(again->computeObservationLikelihood(scan, robot), map.computeObservationLikelihood(scan, robot));
}

TEST(MetricMap, ScansMakeTheGrid) {
  CSemanticMap map;
  map.insertion.grid_resolution_m = 0.1;
  EXPECT_TRUE(map.isEmpty());
  ASSERT_TRUE(map.insertObservation(test::scanOfRoom(3, 2), CPose3D(1, 0.5, 0, 0, 0, 0)));
  ASSERT_TRUE(map.occupancy);
  EXPECT_NEAR(map.occupancy->getResolution(), 0.1, 1e-6);
  const double free = map.occupancy->getPos(1, 1.5), wall = map.occupancy->getPos(4.02F, 0.5F);
  EXPECT_GT(free, 0.55);
  EXPECT_LT(wall, 0.45);
  EXPECT_EQ(map.world_from_robot.size(), 1U);
  EXPECT_EQ(map.world_from_robot[0].t, 1700000001);
  EXPECT_FALSE(map.isEmpty());

  const CSemanticMap copy = map;
  for (int i = 0; i < 3; ++i) map.insertObservation(test::scanOfRoom(3, 2), CPose3D(1, 0.5, 0, 0, 0, 0));
  EXPECT_EQ(copy.occupancy->getPos(1, 1.5), static_cast<float>(free)) << "a copy stays as it was";
  EXPECT_GT(map.occupancy->getPos(1, 1.5), static_cast<float>(free));
  EXPECT_EQ(map.world_from_robot.size(), 1U) << "of the same time";
  map.genericMapParams.enableObservationInsertion = false;
  EXPECT_FALSE(map.insertObservation(test::scanOfRoom(3, 2), CPose3D()));
}

TEST(MetricMap, DetectionsMakeLandmarks) {
  CSemanticMap truth = mapWithCamera();
  truth.landmarks.resize(1);  // the chair at (1, 1)
  CSemanticMap map = truth;
  map.landmarks.clear();
  for (int i = 0; i < 8; ++i) {
    const CPose3D robot(-0.8 + 0.05 * i, 0.4 + 0.1 * i, 0, 0.25 - 0.05 * i, 0, 0);
    auto seen = seenFrom(truth, robot);
    seen.timestamp = mrpt::Clock::fromDouble(1700000000 + i);
    ASSERT_EQ(seen.items.size(), 1U) << i;
    EXPECT_TRUE(map.insertObservation(seen, robot));
  }
  ASSERT_EQ(map.landmarks.size(), 1U);
  EXPECT_NEAR(map.landmarks[0].position.x(), 1, 0.1);
  EXPECT_NEAR(map.landmarks[0].position.y(), 1, 0.1);
  EXPECT_GT(map.landmarks[0].existence, 0.95);
  EXPECT_EQ(map.seen.at(map.landmarks[0].id).first, 1700000000);
  EXPECT_EQ(map.seen.at(map.landmarks[0].id).last, 1700000007);
  map.provenance.objects.clear();
  EXPECT_FALSE(map.insertObservation(seenFrom(truth, CPose3D(-0.8, 0.4, 0, 0.25, 0, 0)), CPose3D()))
      << "sizes are not known";
}

TEST(MetricMap, ClearKeepsOptionsOnly) {
  CSemanticMap map = mapWithCamera();
  map.occupancy->likelihoodOptions.LF_stdHit = 0.125F;
  const CSemanticMap copy = map;
  map.clear();
  EXPECT_TRUE(map.isEmpty());
  EXPECT_TRUE(map.world_from_robot.empty());
  EXPECT_EQ(map.occupancy->likelihoodOptions.LF_stdHit, 0.125F);
  EXPECT_EQ(map.likelihood.camera_fx, 262.5);
  EXPECT_FALSE(map.provenance.objects.empty()) << "the classes are needed to begin anew";
  EXPECT_FALSE(copy.isEmpty());
  EXPECT_EQ(copy.occupancy->getXMax(), test::sampleMap().occupancy->getXMax());
}

TEST(MetricMap, IsDrawnWithItsObjects) {
  CSemanticMap map = mapWithCamera();
  const auto drawn = map.getVisualization();
  EXPECT_TRUE(drawn->getByName("swivel_chair 1"));
  EXPECT_TRUE(drawn->getByName("sofa 2"));
  EXPECT_TRUE(drawn->getByName("door 7"));
  EXPECT_TRUE(drawn->getByName("trajectory"));
  const auto box = drawn->getBoundingBox();
  EXPECT_NEAR(box.min.x, -1, 0.3);
  EXPECT_NEAR(box.max.x, 5, 0.3);
  map.genericMapParams.enableSaveAs3DObject = false;
  EXPECT_TRUE(map.getVisualization()->empty());
}

TEST(MetricMap, IsSavedForPeopleAndPrograms) {
  const test::TemporaryFolder folder;
  const CSemanticMap map = mapWithCamera();
  CMultiMetricMap maps;
  maps.maps.push_back(std::make_shared<CSemanticMap>(map));
  maps.saveMetricMapRepresentationToFile(folder.file("all").string());
  const std::string stem = "all_roomgraph__CSemanticMap_00";
  EXPECT_EQ(bytesOfMap(loadMap(folder.file(stem + ".rgmap"))), bytesOfMap(map));
  mrpt::opengl::COpenGLScene scene;
  ASSERT_TRUE(scene.loadFromFile(folder.file(stem + ".3Dscene").string()));
  EXPECT_TRUE(scene.getByName("sofa 2"));
  EXPECT_THAT(folder.read(stem + "_objects.txt"),
              HasSubstr("\n2 sofa 3.6 -1 0.01 0.6 0.7 0.5 0.9 0.93 17\n"));
  EXPECT_TRUE(std::filesystem::exists(folder.file(stem + "_grid.png")));
  EXPECT_THAT(messageOf<RunError>([&] { map.saveMetricMapRepresentationToFile("/nowhere/map"); }),
              HasSubstr("/nowhere/map.rgmap"));
}

TEST(MetricMap, MatchesLikeItsGrid) {
  CSemanticMap map = mapWithCamera();
  EXPECT_THAT(map.asString(), HasSubstr("3 objects and 120 x 80 cells"));
  EXPECT_EQ(map.compute3DMatchingRatio(&map, CPose3D(), {}), 0);
  mrpt::tfest::TMatchingPairList pairs;
  mrpt::maps::TMatchingExtraResults extra;
  map.occupancy.reset();
  map.determineMatching2D(&map, {}, pairs, {}, extra);
  EXPECT_TRUE(pairs.empty());
}

}  // namespace
}  // namespace roomgraph
