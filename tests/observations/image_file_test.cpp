// SPDX-License-Identifier: BSD-3-Clause
// Pictures of files: read as OpenCV reads them, with memory bounded by the size of the file.
#include "roomgraph/observations/image_file.h"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

#include "memory_limit.h"
#include "temporary_folder.h"

namespace roomgraph {
namespace {

class ImageFile : public ::testing::Test {
 protected:
  const test::TemporaryFolder folder_;
};

TEST_F(ImageFile, IsReadAsOpenCvReadsIt) {
  cv::Mat noise(57, 33, CV_8UC3);
  cv::RNG(5).fill(noise, cv::RNG::UNIFORM, 0, 255);
  for (const char* name : {"a.png", "a.jpg", "a.ppm"}) {
    const auto file = folder_.file(name);
    ASSERT_TRUE(cv::imwrite(file.string(), noise));
    for (const int flags : {cv::IMREAD_COLOR, cv::IMREAD_GRAYSCALE, cv::IMREAD_UNCHANGED}) {
      const cv::Mat read = readImageFile(file, flags), expected = cv::imread(file.string(), flags);
      ASSERT_EQ(read.size(), expected.size()) << name;
      ASSERT_EQ(read.type(), expected.type()) << name;
      EXPECT_EQ(cv::norm(read, expected, cv::NORM_INF), 0) << name;
    }
  }
}

TEST_F(ImageFile, WhatIsNoPictureIsEmpty) {
  EXPECT_TRUE(readImageFile(folder_.file("none.png"), cv::IMREAD_COLOR).empty());
  EXPECT_TRUE(readImageFile(folder_.path(), cv::IMREAD_COLOR).empty());
  EXPECT_TRUE(readImageFile(folder_.write("text.png", "no picture"), cv::IMREAD_COLOR).empty());
  EXPECT_TRUE(readImageFile("/dev/zero", cv::IMREAD_COLOR).empty());
}

// 30000 x 30000 pixels would be 0.9 GB in grey and 2.7 GB in colour; the file has 20 bytes.
TEST_F(ImageFile, ASizeInAHeaderDoesNotFillTheMemory) {
  const auto file = folder_.write("x.ppm", "P6\n30000 30000\n255\nabc");
  const double before = test::peakMegabytes();
  EXPECT_TRUE(readImageFile(file, cv::IMREAD_GRAYSCALE).empty());
  EXPECT_TRUE(readImageFile(file, cv::IMREAD_COLOR).empty());
  EXPECT_LT(test::peakMegabytes() - before, 100);
}

// A blank picture is what is packed most: 21 million pixels in a few dozen kilobytes.
TEST_F(ImageFile, ALargeBlankPictureIsRead) {
  const auto file = folder_.file("blank.png");
  ASSERT_TRUE(cv::imwrite(file.string(), cv::Mat(4000, 6000, CV_8UC3, cv::Scalar(0, 0, 0))));
  ASSERT_LT(std::filesystem::file_size(file), 200000u);
  EXPECT_EQ(readImageFile(file, cv::IMREAD_COLOR).size(), cv::Size(6000, 4000));
}

// Nested limits: the outer one is in force again.
TEST_F(ImageFile, TheLimitEndsWithItsScope) {
  const AllocationLimit outer(1u << 20);
  { const ImageMemoryLimit limit(10); }
  EXPECT_NO_THROW(cv::Mat(12000, 12000, CV_8UC1)) << "144 MB: below the 256 MB of a record";
  const ImageMemoryLimit limit(10);
  EXPECT_ANY_THROW(cv::Mat(12000, 12000, CV_8UC1));
}

}  // namespace
}  // namespace roomgraph
