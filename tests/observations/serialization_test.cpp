// SPDX-License-Identifier: BSD-3-Clause
// Serialisation round trips of every class, older versions and truncated data.
#include <gmock/gmock.h>
#include <mrpt/core/Clock.h>
#include <mrpt/io/CMemoryStream.h>
#include <mrpt/opengl/CSetOfObjects.h>
#include <mrpt/rtti/CObject.h>
#include <mrpt/serialization/CArchive.h>

#include <functional>
#include <sstream>

#include "random_poses.h"
#include "roomgraph/observations/CObservationDetections.h"
#include "roomgraph/observations/CSemanticMap.h"
#include "roomgraph/observations/register_classes.h"

namespace roomgraph {
namespace {

using mrpt::serialization::CSerializable;
using test::Random;

mrpt::serialization::CSerializable::Ptr roundTrip(const CSerializable& object) {
  mrpt::io::CMemoryStream stream;
  auto archive = mrpt::serialization::archiveFrom(stream);
  archive << object;
  stream.Seek(0);
  CSerializable::Ptr back;
  archive >> back;
  EXPECT_EQ(stream.getPosition(), stream.getTotalBytesCount()) << "everything that was written is read";
  return back;
}

CObservationDetections detections() {
  CObservationDetections out;
  out.timestamp = mrpt::Clock::fromDouble(1700000001.5);
  out.sensorLabel = "DETECTOR";
  out.setSensorPose(mrpt::poses::CPose3D(1, 2, 3, 0.1, 0.2, 0.3));
  out.image_label = "KINECT";
  out.image_width = 640;
  out.image_height = 480;
  out.model = "yolox-nano";
  out.model_hash = "abc123";
  out.score_threshold = 0.25f;
  out.nms_threshold = 0.5f;
  out.items = {{"chair", 0.75, 1, 2, 30.5, 40, 7}, {"door", 0.1, -3, 0, 1 / 3.0, 20, -1, {3, 2, {1, 5}}}};
  out.unsought = {"sofa"};
  return out;
}

Landmark landmark(Random& random, ShapeKind kind, int id) {
  Landmark out;
  out.id = LandmarkId{id};
  out.class_name = "sofa";
  out.model = "model " + std::to_string(id);
  out.shape = {kind, random.uniform(0.1, 2), random.uniform(0.1, 2), random.uniform(0.1, 2)};
  out.position = random.vector(5);
  out.yaw = random.uniform(-3, 3);
  out.has_yaw = id % 2 == 0;
  for (int i = 0; i < 16; ++i) out.covariance(i / 4, i % 4) = random.uniform(-1, 1);
  out.existence = random.uniform(0, 1);
  out.class_posterior = {{"sofa", 0.75}, {"door", 0.25}};
  out.observations = 40 + id;
  return out;
}

CSemanticMap semanticMap() {
  Random random(1);
  CSemanticMap out;
  out.origin = "lab.rawlog";
  out.planar = false;
  out.occupancy = mrpt::maps::COccupancyGridMap2D::Create(-1.0f, 1.0f, -2.0f, 2.0f, 0.1f);
  out.occupancy->setCell(3, 4, 0.9f);
  for (int i = 0; i < 3; ++i) out.landmarks.push_back(landmark(random, static_cast<ShapeKind>(i), i));
  for (int i = 0; i < 4; ++i) out.world_from_robot.push_back({1700000000.0 + 0.1 * i, random.pose(5)});
  return out;
}

std::string describe(const CObservationDetections& observation) {
  std::ostringstream text;
  observation.getDescriptionAsText(text);
  return text.str();
}

std::string describe(const CSemanticMap& map) {
  std::ostringstream text;
  text.precision(17);
  text << map.origin << map.planar << (map.occupancy ? map.occupancy->asString() : "none") << "\n";
  for (const auto& l : map.landmarks) {
    text << l.id << l.class_name << l.model << toString(l.shape.kind) << l.shape.width << " " << l.shape.depth
         << " " << l.shape.height << l.position << l.yaw << l.has_yaw << l.covariance << l.existence
         << l.observations;
    for (const auto& [name, probability] : l.class_posterior) text << name << probability;
  }
  for (const auto& p : map.world_from_robot) text << p.t << p.pose.matrix();
  return text.str();
}

template <class T>
std::string describedAfterRoundTrip(const T& object) {
  const auto back = std::dynamic_pointer_cast<T>(roundTrip(object));
  return back ? describe(*back) : "another class";
}

TEST(Serialization, EveryClassComesBackAsItWas) {
  observations::registerClasses();
  observations::registerClasses();
  struct Case {
    std::string name, before, after;
  };
  const CObservationDetections no_detections;  // stamped with the time of its making
  const std::vector<Case> cases = {
      {"roomgraph::CObservationDetections", describe(detections()), describedAfterRoundTrip(detections())},
      {"roomgraph::CObservationDetections", describe(no_detections), describedAfterRoundTrip(no_detections)},
      {"roomgraph::CSemanticMap", describe(semanticMap()), describedAfterRoundTrip(semanticMap())},
      {"roomgraph::CSemanticMap", describe(CSemanticMap()), describedAfterRoundTrip(CSemanticMap())}};
  for (const auto& c : cases) {
    EXPECT_EQ(c.after, c.before) << c.name;
    EXPECT_NE(mrpt::rtti::findRegisteredClass(c.name), nullptr) << c.name;
  }
}

TEST(Serialization, DetectionsKeepEveryField) {
  const auto original = detections();
  const auto back = std::dynamic_pointer_cast<CObservationDetections>(roundTrip(original));
  ASSERT_TRUE(back);
  EXPECT_EQ(back->timestamp, original.timestamp);
  EXPECT_EQ(back->sensorLabel, "DETECTOR");
  EXPECT_TRUE((back->sensorPose() - original.sensorPose()).norm() < 1e-12);
  ASSERT_EQ(back->items.size(), 2u);
  EXPECT_EQ(back->items[0].track, 7);
  EXPECT_EQ(back->items[1].u_min, -3);
  EXPECT_EQ(back->items[1].u_max, 1 / 3.0) << "bit by bit";
  EXPECT_EQ(back->items[1].score, 0.1);
  EXPECT_TRUE(back->items[0].mask.runs.empty());
  EXPECT_EQ(back->items[1].mask.width, 3u);
  EXPECT_EQ(back->items[1].mask.runs, original.items[1].mask.runs);
  EXPECT_THAT(describe(*back), ::testing::HasSubstr("chair 0.75 [1, 2, 30.5, 40] track 7"));
}

TEST(Serialization, DetectionsAreWrittenAsARowOfText) {
  auto seen = detections();
  EXPECT_TRUE(seen.exportTxtSupported());
  EXPECT_EQ(seen.exportTxtDataRow(), "2 chair 0.75 1 2 30.5 40 door 0.1 -3 0 0.333333 20");
  seen.items[0].label = "office chair";
  seen.items[1].label = "";
  EXPECT_EQ(seen.exportTxtDataRow(), "2 office_chair 0.75 1 2 30.5 40 - 0.1 -3 0 0.333333 20")
      << "columns stay columns";
  EXPECT_EQ(CObservationDetections().exportTxtDataRow(), "0");
}

// The picture is 10 m wide, u along x and v against z.
TEST(Serialization, DetectionsAreDrawnWhereTheyAre) {
  auto seen = detections();
  seen.items.resize(1);
  seen.items[0].u_min = 320;
  seen.items[0].u_max = 640;
  seen.items[0].v_min = 0;
  seen.items[0].v_max = 120;
  const auto drawn = seen.getVisualization();
  const auto frame = drawn->getByName("image"), box = drawn->getByName("chair");
  ASSERT_TRUE(frame && box);
  EXPECT_NEAR(frame->getBoundingBox().min.x, -5, 1e-6);
  EXPECT_NEAR(frame->getBoundingBox().max.x, 5, 1e-6);
  EXPECT_NEAR(frame->getBoundingBox().max.z, 3.75, 1e-6);
  EXPECT_NEAR(box->getBoundingBox().min.x, 0, 1e-6) << "the right half";
  EXPECT_NEAR(box->getBoundingBox().max.x, 5, 1e-6);
  EXPECT_NEAR(box->getBoundingBox().max.z, 3.75, 1e-6);
  EXPECT_NEAR(box->getBoundingBox().min.z, 1.875, 1e-6) << "the upper quarter";
  EXPECT_NEAR(box->getBoundingBox().min.y, 0, 1e-6);
}

// As it was written before boxes had 64 bits and masks.
TEST(Serialization, DetectionsOfVersion0AreRead) {
  const auto original = detections();
  mrpt::poses::CPose3D pose;
  original.getSensorPose(pose);
  mrpt::io::CMemoryStream stream;
  auto archive = mrpt::serialization::archiveFrom(stream);
  archive << original.timestamp << original.sensorLabel << pose << original.image_label
          << original.image_width << original.image_height << original.model << original.model_hash
          << original.score_threshold << original.nms_threshold;
  archive.WriteAs<std::uint32_t>(1);
  archive << std::string("chair") << 0.75f << 1.f << 2.f << 30.5f << 40.f << std::int64_t{7};
  stream.Seek(0);
  struct Opened : CObservationDetections {
    using CObservationDetections::serializeFrom;
  } back;
  back.serializeFrom(archive, 0);
  EXPECT_EQ(stream.getPosition(), stream.getTotalBytesCount());
  ASSERT_EQ(back.items.size(), 1u);
  EXPECT_THAT(describe(back), ::testing::HasSubstr("chair 0.75 [1, 2, 30.5, 40] track 7"));
  EXPECT_EQ(back.model_hash, "abc123");
}

TEST(Serialization, MapKeepsItsCells) {
  const auto original = semanticMap();
  const auto back = std::dynamic_pointer_cast<CSemanticMap>(roundTrip(original));
  ASSERT_TRUE(back && back->occupancy);
  ASSERT_EQ(back->occupancy->getSizeX(), original.occupancy->getSizeX());
  ASSERT_EQ(back->occupancy->getSizeY(), original.occupancy->getSizeY());
  for (int y = 0; y < static_cast<int>(original.occupancy->getSizeY()); ++y)
    for (int x = 0; x < static_cast<int>(original.occupancy->getSizeX()); ++x)
      ASSERT_EQ(back->occupancy->getCell(x, y), original.occupancy->getCell(x, y));
}

TEST(Serialization, ReadingReplacesWhatWasThere) {
  mrpt::io::CMemoryStream stream;
  auto archive = mrpt::serialization::archiveFrom(stream);
  archive << CSemanticMap();
  stream.Seek(0);
  CSemanticMap full = semanticMap();
  archive >> full;
  EXPECT_TRUE(full.landmarks.empty());
  EXPECT_TRUE(full.world_from_robot.empty());
  EXPECT_FALSE(full.occupancy);
}

TEST(Serialization, TruncatedDataIsAnErrorNotAnObject) {
  mrpt::io::CMemoryStream whole;
  auto out = mrpt::serialization::archiveFrom(whole);
  out << semanticMap();
  for (const double share : {0.1, 0.5, 0.99}) {
    mrpt::io::CMemoryStream part;
    part.Write(whole.getRawBufferData(),
               static_cast<std::size_t>(share * static_cast<double>(whole.getTotalBytesCount())));
    part.Seek(0);
    auto in = mrpt::serialization::archiveFrom(part);
    CSemanticMap map;
    EXPECT_ANY_THROW(in >> map) << share;
  }
}

}  // namespace
}  // namespace roomgraph
