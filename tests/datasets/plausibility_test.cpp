// SPDX-License-Identifier: BSD-3-Clause
// Implausible records left out alike by RawlogReader and inspectRawlog.
#include <gmock/gmock.h>

#include <functional>
#include <limits>

#include "rawlog_maker.h"
#include "roomgraph/datasets/rawlog_reader.h"
#include "roomgraph/datasets/rawlog_report.h"
#include "roomgraph/observations/register_classes.h"

namespace roomgraph {
namespace {

using namespace roomgraph::test;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// Reading and inspecting leave the second of three records out, for one and the same reason.
template <class Make, class Change>
std::string reasonFor(const Make& make, const Change& change) {
  TemporaryFolder folder;
  const auto victim = make(2);
  change(*victim);
  writeRawlog(folder.file("x.rawlog"), {make(1), victim, make(3)});
  RawlogReader reader(folder.file("x.rawlog"));
  int used = 0;
  while (reader.next()) ++used;
  EXPECT_EQ(used, 2);
  const auto report = inspectRawlog(folder.file("x.rawlog"));
  EXPECT_EQ(report.skipped, reader.statistics().skipped);
  EXPECT_THAT(reader.statistics().skipped, SizeIs(1));
  return reader.statistics().skipped.empty() ? "" : reader.statistics().skipped.begin()->first;
}

TEST(Plausibility, Odometry) {
  const auto make = [](double t) { return makeOdometry(t, 1, 2, 0.3); };
  EXPECT_EQ(reasonFor(make, [](auto& o) { o.odometry.x(kNan); }), "CObservationOdometry: pose is not finite");
  EXPECT_EQ(reasonFor(make, [](auto& o) { o.odometry.y(1e12); }),
            "CObservationOdometry: pose is more than 1000 km away");
  EXPECT_THAT(reasonFor(make, [](auto& o) { o.odometry.phi(-kNan); }), HasSubstr("not finite"));
}

TEST(Plausibility, Scans) {
  const auto make = [](double t) { return makeScan(t); };
  EXPECT_EQ(reasonFor(make, [](auto& s) { s.sensorPose.x(kNan); }),
            "CObservation2DRangeScan: sensor pose is not finite");
  EXPECT_EQ(reasonFor(make, [](auto& s) { s.sensorPose.z(-1e7); }),
            "CObservation2DRangeScan: sensor pose is more than 1000 km away");
  EXPECT_EQ(
      reasonFor(make, [](auto& s) { s.aperture = 9; }),
      "CObservation2DRangeScan: aperture of 9 rad is impossible (it is in radians, first beam to last)");
  EXPECT_THAT(reasonFor(make, [](auto& s) { s.aperture = 0; }), HasSubstr("aperture"));
  EXPECT_THAT(reasonFor(make, [](auto& s) { s.aperture = std::numeric_limits<float>::quiet_NaN(); }),
              HasSubstr("aperture"));
  EXPECT_THAT(reasonFor(make, [](auto& s) { s.maxRange = std::numeric_limits<float>::infinity(); }),
              HasSubstr("maximum range"));
}

TEST(Plausibility, Images) {
  const auto make = [](double t) { return makeImages(t); };
  const auto reason = [&](const std::function<void(mrpt::obs::CObservation3DRangeScan&)>& change) {
    return reasonFor(make, change);
  };
  EXPECT_EQ(reason([](auto& i) { i.sensorPose.setFromValues(0, 0, kNan, 0, 0, 0); }),
            "CObservation3DRangeScan: sensor pose is not finite");
  EXPECT_THAT(reason([](auto& i) { i.relativePoseIntensityWRTDepth.x(1e12); }), HasSubstr("colour camera"));
  EXPECT_THAT(reason([](auto& i) { i.rangeUnits = 1e12f; }), HasSubstr("rangeUnits"));
  EXPECT_THAT(reason([](auto& i) { i.cameraParams.cx(kNan); }), HasSubstr("depth camera intrinsics"));
  EXPECT_THAT(reason([](auto& i) { i.cameraParamsIntensity.fx(1e12); }),
              HasSubstr("colour camera intrinsics"));
  EXPECT_THAT(reason([](auto& i) { i.cameraParamsIntensity.k1(kNan); }), HasSubstr("distortion"));
}

TEST(Plausibility, Detections) {
  observations::registerClasses();
  const auto make = [](double t) {
    auto out = std::make_shared<CObservationDetections>();
    out->timestamp = mrpt::Clock::fromDouble(t);
    out->items.push_back({"chair", 0.5, 1, 2, 3, 4, -1, {3, 2, {2, 4}}});
    return out;
  };
  EXPECT_THAT(reasonFor(make, [](auto& d) { d.items[0].score = kNan; }), HasSubstr("score of a box"));
  EXPECT_THAT(reasonFor(make, [](auto& d) { d.items[0].score = 1.5; }), HasSubstr("score of a box"));
  EXPECT_THAT(reasonFor(make, [](auto& d) { d.items[0].u_max = 1e12; }), HasSubstr("a box is not finite"));
  EXPECT_THAT(reasonFor(make, [](auto& d) { d.nms_threshold = -std::numeric_limits<float>::infinity(); }),
              HasSubstr("threshold"));
  EXPECT_THAT(reasonFor(make,
                        [](auto& d) {
                          d.items[0].mask = {1u << 31, 1u << 31, {0}};
                        }),
              HasSubstr("mask is too large"));
  EXPECT_THAT(reasonFor(make, [](auto& d) { d.items[0].mask.runs = {2, 3}; }), HasSubstr("mask's runs"));
}

TEST(Plausibility, TimesAndTheirNeighbours) {
  const auto make = [](double t) { return makeScan(1e9 + t); };
  const auto at = [](double t) { return [t](auto& s) { s.timestamp = mrpt::Clock::fromDouble(t); }; };
  EXPECT_THAT(reasonFor(make, at(-1e9)), HasSubstr("time stamp is not between 1970 and 2200"));
  EXPECT_THAT(reasonFor(make, at(9e9)), HasSubstr("time stamp is not between 1970 and 2200"));
  EXPECT_THAT(reasonFor(make, at(1e9 + 7200)), HasSubstr("more than a minute from those before and after"));
}

TEST(Plausibility, ABadStepOfActionsIsLeftOut) {
  TemporaryFolder folder;
  for (const double bad : {kNan, 1e12, 5000.0}) {
    writeRawlog(folder.file("x.rawlog"),
                {makeAction(1, 1, 0, 0), makeSensoryFrame({makeScan(1)}), makeAction(2, bad, 0, 0),
                 makeSensoryFrame({makeScan(2)}), makeAction(3, 1, 0, 0), makeSensoryFrame({makeScan(3)})});
    RawlogReader reader(folder.file("x.rawlog"));
    std::vector<double> x;
    while (const auto record = reader.next())
      if (const auto* reading = std::get_if<OdometryReading>(&*record))
        x.push_back(reading->odom_from_robot.x);
    EXPECT_THAT(x, testing::ElementsAre(1, 2)) << bad;
    ASSERT_THAT(reader.statistics().skipped, SizeIs(1)) << bad;
    EXPECT_THAT(reader.statistics().skipped.begin()->first, HasSubstr("CActionCollection: movement"));
    EXPECT_EQ(inspectRawlog(folder.file("x.rawlog")).skipped, reader.statistics().skipped);
  }
}

TEST(Plausibility, LargeButPossibleValuesAreUsed) {
  TemporaryFolder folder;
  const auto circle = makeScan(1);
  circle->aperture = static_cast<float>(2 * M_PI);
  const auto far = makeScan(2);
  far->sensorPose.x(9e5);
  const auto single = makeScan(3, 2, 1);
  single->aperture = 0;
  writeRawlog(folder.file("x.rawlog"), {circle, far, single, makeOdometry(4, 9e5, 0, 1000)});
  RawlogReader reader(folder.file("x.rawlog"));
  int used = 0;
  while (reader.next()) ++used;
  EXPECT_EQ(used, 4);
  EXPECT_THAT(reader.statistics().skipped, IsEmpty());
}

}  // namespace
}  // namespace roomgraph
