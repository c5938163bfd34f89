// SPDX-License-Identifier: BSD-3-Clause
// Comments unpacked into records of their own class: which records change, and that all others keep their
// bytes.
#include "roomgraph/datasets/detection_records.h"

#include <gmock/gmock.h>
#include <mrpt/io/CFileGZInputStream.h>

#include <cmath>

#include "errors_of.h"
#include "rawlog_maker.h"
#include "roomgraph/core/errors.h"
#include "roomgraph/observations/detection_comment.h"
#include "roomgraph/observations/register_classes.h"

namespace roomgraph {
namespace {

using namespace test;

std::shared_ptr<CObservationDetections> recordAt(double t) {
  auto out = std::make_shared<CObservationDetections>();
  out->timestamp = mrpt::Clock::fromDouble(t);
  out->sensorLabel = "BOXES";
  out->items.push_back({"office chair", 0.1, 1, 2, 1 / 3.0, 4, 7, {3, 2, {1, 5}}});
  return out;
}

std::shared_ptr<mrpt::obs::CObservationComment> commentOf(double t) {
  return std::make_shared<mrpt::obs::CObservationComment>(toComment(*recordAt(t)));
}

// MRPT writes poses as quaternions, in which a zero may get another sign each time: the poses here are all none.
Object withoutSignsOfZero(const Object& object) {
  const auto reset = [](mrpt::obs::CObservation& observation) {
    mrpt::poses::CPose3D pose;
    observation.getSensorPose(pose);
    EXPECT_LT(pose.norm() + std::abs(pose.yaw()) + std::abs(pose.pitch()) + std::abs(pose.roll()), 1e-12);
    observation.setSensorPose(mrpt::poses::CPose3D());
  };
  if (const auto observation = std::dynamic_pointer_cast<mrpt::obs::CObservation>(object)) reset(*observation);
  if (const auto frame = std::dynamic_pointer_cast<mrpt::obs::CSensoryFrame>(object))
    for (const auto& observation : *frame) reset(*observation);
  return object;
}

std::vector<std::string> recordsIn(const std::filesystem::path& file) {
  observations::registerClasses();
  mrpt::io::CFileGZInputStream in(file.string());
  auto archive = mrpt::serialization::archiveFrom(in);
  std::vector<std::string> out;
  while (!in.checkEOF()) {
    try {
      out.push_back(bytesOf(withoutSignsOfZero(archive.ReadObject())));
    } catch (const mrpt::serialization::CExceptionEOF&) {
      break;
    }
  }
  return out;
}

class DetectionRecordsTest : public ::testing::Test {
 protected:
  TemporaryFolder folder;
  std::filesystem::path in = folder.file("x.rawlog"), out = folder.file("y.rawlog"),
                        expected = folder.file("z.rawlog");
};

TEST_F(DetectionRecordsTest, CommentsBecomeRecords) {
  auto remark = std::make_shared<mrpt::obs::CObservationComment>();
  remark->text = "a remark of somebody";
  auto damaged = commentOf(1.3);
  damaged->text.resize(damaged->text.size() / 2);
  writeRawlog(in, {makeScan(1), commentOf(1.1), remark, damaged, recordAt(1.4)});
  double share = 0;
  const DetectionRecords counts = exportDetectionRecords(in, out, [&](double done) { share = done; });
  EXPECT_EQ(counts.records, 5U);
  EXPECT_EQ(counts.detections, 2U);
  EXPECT_EQ(counts.damaged, 1U);
  EXPECT_NEAR(share, 1, 1e-9);
  writeRawlog(expected, {makeScan(1), recordAt(1.1), remark, damaged, recordAt(1.4)});
  EXPECT_EQ(recordsIn(out), recordsIn(expected));
}

TEST_F(DetectionRecordsTest, FramesAreUnpackedToo) {
  auto action = std::make_shared<mrpt::obs::CActionCollection>();
  auto frame = mrpt::obs::CSensoryFrame::Create(), meant = mrpt::obs::CSensoryFrame::Create();
  frame->insert(makeScan(1));
  frame->insert(commentOf(1.1));
  meant->insert(makeScan(1));
  meant->insert(recordAt(1.1));
  writeRawlog(in, {action, frame});
  const DetectionRecords counts = exportDetectionRecords(in, out);
  EXPECT_EQ(counts.detections, 1U);
  writeRawlog(expected, {action, meant});
  EXPECT_EQ(recordsIn(out), recordsIn(expected));
}

TEST_F(DetectionRecordsTest, TheInputIsNotWritten) {
  writeRawlog(in, {commentOf(1)});
  const std::string before = readBytes(in);
  EXPECT_NE(messageOf<ConfigError>([&] { exportDetectionRecords(in, in); }), "");
  EXPECT_EQ(readBytes(in), before);
  EXPECT_THAT(messageOf<InputError>([&] { exportDetectionRecords(folder.file("none.rawlog"), out); }),
              ::testing::HasSubstr("none.rawlog"));
  EXPECT_FALSE(std::filesystem::exists(out));
}

}  // namespace
}  // namespace roomgraph
