// SPDX-License-Identifier: BSD-3-Clause
// Darknet configurations as somebody may have written or damaged them.
#include "network_files.h"

#include <gmock/gmock.h>

#include "errors_of.h"
#include "roomgraph/core/errors.h"
#include "roomgraph/detection/register_classes.h"
#include "temporary_folder.h"

namespace roomgraph {
namespace {

class DarknetInput : public ::testing::Test {
 protected:
  cv::Size sizeOf(const std::string& text) const {
    return darknetInputSize(folder_.write("x.cfg", text).string());
  }
  std::string problem(const std::string& text) const {
    return test::messageOf<InputError>([&] { sizeOf(text); });
  }
  const test::TemporaryFolder folder_;
};

TEST(NetworkSpecText, HasAFileAFormatAndARate) {
  detection::registerClasses();
  const auto spec = parseNetworkSpec("a/doors.onnx:ade20k@2.5");
  EXPECT_EQ(spec.file, "a/doors.onnx");
  EXPECT_EQ(spec.format, "ade20k");
  EXPECT_EQ(spec.rate_hz, 2.5);
  EXPECT_EQ(parseNetworkSpec("doors.onnx @ 4").file, "doors.onnx");
  EXPECT_EQ(parseNetworkSpec("doors.onnx @ 4").rate_hz, 4);
  const auto every = parseNetworkSpec("me@home/doors.onnx");
  EXPECT_EQ(every.file, "me@home/doors.onnx") << "no number follows this @";
  EXPECT_EQ(every.rate_hz, 0);
  for (const std::string rate : {"0", "-1", "1e9", "nan"})
    EXPECT_THROW(parseNetworkSpec("doors.onnx@" + rate), ConfigError) << rate;
}

TEST_F(DarknetInput, IsThatOfItsFirstSection) {
  EXPECT_EQ(sizeOf("[net]\nwidth=64\nheight = 32\n[convolutional]\nwidth=7\nheight=7\n"), cv::Size(64, 32));
  EXPECT_EQ(sizeOf("# a comment\n[net]\n  width\t=\t416  \r\nheight=416\r\n"), cv::Size(416, 416));
}

TEST_F(DarknetInput, IsMissingWhereNoNumberIs) {
  for (const char* width : {"", "=", "=-3", "=6x", "=123456", "=1 2", "s=64"})
    EXPECT_THAT(problem("[net]\nheight=64\nwidth" + std::string(width) + "\n"),
                ::testing::HasSubstr("[net] gives no width and height"))
        << width;
}

// A line of any length needs no more stack than a short one.
TEST_F(DarknetInput, LongLinesAreOnlyLong) {
  const std::string spaces(1u << 20, ' '), digits(1u << 20, '1');
  EXPECT_EQ(sizeOf("[net]\n" + spaces + "width" + spaces + "=64" + spaces + "\nheight=64\n"),
            cv::Size(64, 64));
  EXPECT_THAT(problem("[net]\nwidth=" + digits + "\nheight=64\n" + spaces),
              ::testing::HasSubstr("gives no width and height"));
}

}  // namespace
}  // namespace roomgraph
