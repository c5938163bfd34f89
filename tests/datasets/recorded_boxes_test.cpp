// SPDX-License-Identifier: BSD-3-Clause
// Recorded detections as comments or objects, in reader, report and peek.
#include <gmock/gmock.h>

#include "rawlog_maker.h"
#include "roomgraph/core/errors.h"
#include "roomgraph/datasets/rawlog_peek.h"
#include "roomgraph/datasets/rawlog_reader.h"
#include "roomgraph/datasets/rawlog_report.h"
#include "roomgraph/observations/detection_comment.h"

namespace roomgraph {
namespace {

using namespace roomgraph::test;
using mrpt::obs::CObservationComment;
using ::testing::ElementsAre;
using ::testing::Pair;

CObservationDetections::Ptr boxesAt(double t) {
  auto out = std::make_shared<CObservationDetections>();
  out->timestamp = mrpt::Clock::fromDouble(t);
  out->sensorLabel = "DETECTIONS";
  out->items.push_back({"chair", 0.5, 1, 2, 3, 4, 7});
  return out;
}

CObservationComment::Ptr plainCommentAt(double t) {
  return std::make_shared<CObservationComment>(toComment(*boxesAt(t)));
}

CObservationComment::Ptr damagedAt(double t) {
  auto out = plainCommentAt(t);
  out->text.resize(out->text.size() - 5);
  return out;
}

CObservationComment::Ptr remarkAt(double t) {
  auto out = std::make_shared<CObservationComment>();
  out->timestamp = mrpt::Clock::fromDouble(t);
  out->text = "the cleaner comes in";
  return out;
}

class RecordedBoxes : public ::testing::Test {
 protected:
  TemporaryFolder folder_;
  std::filesystem::path file_ = folder_.file("x.rawlog");
  const std::string broken_ = "broken record: CObservationComment: its text is no valid record of detections";
};

TEST_F(RecordedBoxes, BothFormsAreReadAndDamagedOnesCounted) {
  writeRawlog(file_, {plainCommentAt(1), boxesAt(2), damagedAt(3), remarkAt(4), damagedAt(5), makeScan(6)});
  RawlogReader reader(file_);
  std::vector<double> times;
  while (const auto record = reader.next())
    if (const auto* boxes = std::get_if<std::shared_ptr<CObservationDetections>>(&*record)) {
      times.push_back(timeOf(*record));
      EXPECT_EQ((*boxes)->sensorLabel, "DETECTIONS");
      EXPECT_EQ((*boxes)->items.at(0).track, 7);
    }
  EXPECT_THAT(times, ElementsAre(::testing::DoubleNear(1, 1e-6), ::testing::DoubleNear(2, 1e-6)));
  EXPECT_THAT(reader.statistics().skipped,
              ElementsAre(Pair("CObservationComment: not used", 1), Pair(broken_, 2)));
  EXPECT_EQ(reader.statistics().used.at("CObservationDetections"), 2);
}

TEST_F(RecordedBoxes, InSensoryFramesToo) {
  writeRawlog(file_,
              {makeAction(1, 1, 0, 0), makeSensoryFrame({plainCommentAt(1.1), damagedAt(1.2), makeScan(1.3)})});
  RawlogReader reader(file_);
  int boxes = 0, scans = 0;
  while (const auto record = reader.next()) {
    boxes += std::holds_alternative<std::shared_ptr<CObservationDetections>>(*record);
    scans += std::holds_alternative<Scan>(*record);
  }
  EXPECT_EQ(boxes, 1);
  EXPECT_EQ(scans, 1);
  EXPECT_THAT(reader.statistics().skipped, ElementsAre(Pair(broken_, 1)));
}

TEST_F(RecordedBoxes, TheReportNamesThem) {
  writeRawlog(file_, {makeScan(1), plainCommentAt(1), damagedAt(2), plainCommentAt(3)});
  const auto report = inspectRawlog(file_);
  ASSERT_EQ(report.sensors.size(), 2u);
  EXPECT_EQ(report.sensors[1].label, "DETECTIONS");
  EXPECT_EQ(report.sensors[1].count, 2);
  EXPECT_TRUE(report.sensors[1].used);
  EXPECT_THAT(report.skipped, ElementsAre(Pair(broken_, 1)));
}

TEST_F(RecordedBoxes, AGlanceAtTheBeginning) {
  const auto peek = [&](const std::vector<Object>& objects) {
    writeRawlog(file_, objects);
    const RawlogPeek seen = peekRawlog(file_);
    return std::pair{seen.frames, seen.detections};
  };
  using P = std::pair<bool, bool>;
  EXPECT_EQ(peek({makeScan(1), makeOdometry(2, 0, 0, 0)}), P(false, false));
  EXPECT_EQ(peek({makeScan(1), makeImages(2)}), P(true, false));
  EXPECT_EQ(peek({makeImages(1), remarkAt(1), damagedAt(2)}), P(true, false));
  EXPECT_EQ(peek({makeImages(1), plainCommentAt(1)}), P(true, true));
  EXPECT_EQ(peek({makeImages(1), boxesAt(1)}), P(true, true));
  EXPECT_EQ(peek({makeAction(1, 1, 0, 0), makeSensoryFrame({makeImages(1.1), plainCommentAt(1.1)})}),
            P(true, true));
  EXPECT_EQ(peek({makeScan(1), makeScan(1e9), makeImages(1.1), makeImages(40), plainCommentAt(40)}), P(true, true))
      << "a wrong stamp, and boxes that start late";
  EXPECT_THROW(peekRawlog(folder_.file("none.rawlog")), InputError);
}

TEST_F(RecordedBoxes, AGlanceHasAnEnd) {
  std::vector<Object> objects{makeImages(1)};
  writeRawlog(file_, objects);
  EXPECT_TRUE(peekRawlog(file_).whole);
  objects.resize(20000, makeOdometry(2, 0, 0, 0));
  objects.push_back(plainCommentAt(3));
  writeRawlog(file_, objects);
  const RawlogPeek seen = peekRawlog(file_);
  EXPECT_TRUE(seen.frames);
  EXPECT_FALSE(seen.detections);
  EXPECT_FALSE(seen.whole) << "whether there are boxes is not known";
}

TEST_F(RecordedBoxes, InFramesBesideObjectsThatAreMissing) {
  writeBytes(file_, withNull(makeSensoryFrame({makeScan(1), makeImages(1.1), plainCommentAt(1.1)})));
  const RawlogPeek seen = peekRawlog(file_);
  EXPECT_TRUE(seen.frames);
  EXPECT_TRUE(seen.detections);
}

}  // namespace
}  // namespace roomgraph
