// SPDX-License-Identifier: BSD-3-Clause
// RawlogCopy: unchanged bytes, order of inserted detections, replaced detections, external images.
#include "roomgraph/datasets/rawlog_copy.h"

#include <gtest/gtest.h>
#include <zlib.h>

#include "rawlog_maker.h"
#include "roomgraph/core/errors.h"
#include "roomgraph/datasets/rawlog_reader.h"
#include "roomgraph/observations/detection_comment.h"

namespace roomgraph {
namespace {

using namespace test;

std::shared_ptr<CObservationDetections> detectionsAt(double t, const std::string& label = "chair") {
  auto out = std::make_shared<CObservationDetections>();
  out->timestamp = mrpt::Clock::fromDouble(t);
  out->items.push_back({label, 0.5, 1, 2, 3, 4, 7});
  return out;
}

// The form in which they are written.
std::shared_ptr<mrpt::obs::CObservationComment> commentAt(double t, const std::string& label = "chair") {
  return std::make_shared<mrpt::obs::CObservationComment>(toComment(*detectionsAt(t, label)));
}

std::string unzipped(const std::filesystem::path& file) {
  gzFile in = gzopen(file.c_str(), "rb");
  std::string bytes;
  char block[4096];
  for (int got = 0; (got = gzread(in, block, sizeof block)) > 0;)
    bytes.append(block, static_cast<std::size_t>(got));
  EXPECT_EQ(gzclose(in), Z_OK);
  return bytes;
}

std::string joined(const std::vector<Object>& objects) {
  std::string bytes;
  for (const auto& object : objects) bytes += bytesOf(object);
  return bytes;
}

class RawlogCopyTest : public ::testing::Test {
 protected:
  TemporaryFolder folder;
  std::filesystem::path in = folder.file("x.rawlog"), out = folder.file("y.rawlog");
};

TEST_F(RawlogCopyTest, BytesStayAndDetectionsComeBeforeTheirImage) {
  const std::vector<Object> input{makeOdometry(1, 0, 0, 0), makeImages(1.1), makeScan(1.15), makeImages(1.2),
                                  makeScan(1.3)};
  for (const bool gz : {true, false}) {
    writeRawlog(in, input, gz);
    RawlogCopy copy(in, out);
    copy.insert(*detectionsAt(1.1));
    copy.insert(*detectionsAt(1.2, "sofa"));
    copy.finish();
    // Pictures are compressed when they are written: only a copy of the bytes is the same.
    EXPECT_EQ(unzipped(out), joined({input[0], commentAt(1.1), input[1], input[2], commentAt(1.2, "sofa"),
                                     input[3], input[4]}));
  }
}

TEST_F(RawlogCopyTest, OldDetectionsAreReplaced) {
  const auto scan = makeScan(1.05);
  auto remark = std::make_shared<mrpt::obs::CObservationComment>();
  remark->text = "a remark of somebody";
  writeRawlog(in, {detectionsAt(1), scan, commentAt(1.1), remark});
  {
    RawlogCopy given_up(in, out);
    given_up.insert(*detectionsAt(1.02, "sofa"));
  }
  EXPECT_FALSE(std::filesystem::exists(out)) << "a copy is whole or absent";
  RawlogCopy copy(in, out);
  copy.insert(*detectionsAt(1.02, "sofa"));
  copy.finish();
  EXPECT_EQ(unzipped(out), joined({commentAt(1.02, "sofa"), scan, remark}));
}

TEST_F(RawlogCopyTest, SensoryFramesAndTheEndOfTheInput) {
  const std::vector<Object> input{makeAction(1, 1, 0, 0), makeSensoryFrame({makeImages(1.1)}),
                                  makeAction(2, 1, 0, 0), makeSensoryFrame({makeImages(2.1), makeScan(2.2)})};
  writeRawlog(in, input);
  RawlogCopy copy(in, out);
  for (const double t : {1.1, 2.1, 9.0}) copy.insert(*detectionsAt(t));
  copy.finish();
  EXPECT_EQ(unzipped(out),
            joined({input[0], commentAt(1.1), input[1], input[2], commentAt(2.1), input[3], commentAt(9)}));
}

TEST_F(RawlogCopyTest, SensoryFramesWithMissingObjects) {
  const std::string frame = withNull(makeSensoryFrame({makeScan(1), makeImages(2)}));
  writeBytes(in, bytesOf(makeAction(1, 1, 0, 0)) + frame);
  RawlogCopy copy(in, out);
  copy.insert(*detectionsAt(2));
  copy.finish();
  EXPECT_EQ(unzipped(out), joined({makeAction(1, 1, 0, 0), commentAt(2)}) + frame);
}

TEST_F(RawlogCopyTest, ExternalImagesAreFoundFromElsewhere) {
  std::filesystem::create_directories(folder.file("x_Images"));
  auto images = makeImages(1);
  images->rangeImage_convertToExternalStorage("depth.bin", folder.file("x_Images").string() + "/");
  writeRawlog(in, {images});
  std::filesystem::create_directories(folder.file("elsewhere"));
  for (const auto& copy : {out, folder.file("elsewhere") / "z.rawlog.gz"}) {
    RawlogCopy(in, copy).finish();
    RawlogReader reader(copy);
    const auto record = reader.next();
    ASSERT_TRUE(record) << copy;
    EXPECT_NEAR(std::get<Frame>(*record).depth.at<float>(3, 5), 1.05f, 1e-4);
  }
  RawlogCopy(in, out).finish();  // over an older copy: the link is there already
}

TEST_F(RawlogCopyTest, WrongFilesAreRefused) {
  writeRawlog(in, {makeScan(1)});
  EXPECT_THROW(RawlogCopy(in, in), ConfigError);
  EXPECT_THROW(RawlogCopy(folder.file("none.rawlog"), out), InputError);
  EXPECT_THROW(RawlogCopy(in, folder.file("no") / "such" / "folder.rawlog"), RunError);
  RawlogReader reader(in);
  EXPECT_TRUE(reader.next()) << "the input is as it was";
}

}  // namespace
}  // namespace roomgraph
