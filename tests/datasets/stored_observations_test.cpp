// SPDX-License-Identifier: BSD-3-Clause
// StoredObservationReader: bytes of the file, observations of larger records, what is impossible.
#include "roomgraph/datasets/stored_observations.h"

#include <gmock/gmock.h>

#include "rawlog_maker.h"
#include "roomgraph/core/errors.h"

namespace roomgraph {
namespace {

using namespace test;
using ::testing::HasSubstr;

class StoredObservations : public ::testing::Test {
 protected:
  std::vector<StoredObservation> read() {
    StoredObservationReader reader(file);
    std::vector<StoredObservation> all;
    while (auto next = reader.next()) all.push_back(std::move(*next));
    skipped = reader.skipped();
    truncation = reader.truncation();
    EXPECT_EQ(reader.progress(), 1);
    return all;
  }
  TemporaryFolder folder;
  std::filesystem::path file = folder.file("x.rawlog");
  std::map<std::string, int> skipped;
  std::string truncation;
};

TEST_F(StoredObservations, ComeWithTheirBytesImpossibleOnesToo) {
  auto without_stamp = makeScan(1);
  without_stamp->timestamp = INVALID_TIMESTAMP;
  const std::vector<Object> objects{makeScan(1), makeOdometry(2, std::nan(""), 0, 0), without_stamp,
                                    makeImages(3)};
  writeRawlog(file, objects);
  const auto all = read();
  ASSERT_EQ(all.size(), objects.size());
  for (std::size_t i = 0; i < all.size(); ++i) EXPECT_EQ(all[i].bytes, bytesOf(objects[i]));
  EXPECT_TRUE(skipped.empty());
}

TEST_F(StoredObservations, OfSensoryFramesComeOneByOneWithSummedUpOdometry) {
  const auto frame = makeSensoryFrame({makeScan(1.5), makeImages(1.6)});
  writeRawlog(
      file, {makeAction(1, 0.5, 0, 0), frame, makeAction(2, 0.25, 0, 0), makeSensoryFrame({makeScan(2.5)})});
  const auto all = read();
  ASSERT_EQ(all.size(), 5u);
  for (const auto& stored : all) EXPECT_TRUE(stored.bytes.empty());
  const auto odometry = std::dynamic_pointer_cast<mrpt::obs::CObservationOdometry>(all[3].observation);
  ASSERT_TRUE(odometry);
  EXPECT_NEAR(odometry->odometry.x(), 0.75, 1e-9);
  EXPECT_NEAR(mrpt::Clock::toDouble(odometry->timestamp), 2, 1e-6);
}

TEST_F(StoredObservations, WhatMrptCannotParseIsCountedAndTheEndTold) {
  const std::string scan = bytesOf(makeScan(1));
  writeBytes(file, scan + scan.substr(0, 60) + "\x88" + scan + scan.substr(0, 30));  // 0x88: end mark
  EXPECT_EQ(read().size(), 2u);
  ASSERT_EQ(skipped.size(), 1u);
  EXPECT_THAT(skipped.begin()->first, HasSubstr("broken record"));
  EXPECT_THAT(truncation, HasSubstr("ends in the middle of a record"));
  EXPECT_THROW(StoredObservationReader(folder.file("none")), InputError);
}

}  // namespace
}  // namespace roomgraph
