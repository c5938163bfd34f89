// SPDX-License-Identifier: BSD-3-Clause
// Plain and gzipped text, whole and cut off, against the lines that were written.
#include "gz_lines.h"

#include <gmock/gmock.h>

#include "carmen_maker.h"
#include "errors_of.h"
#include "ordered_records.h"
#include "roomgraph/core/errors.h"

namespace roomgraph {
namespace {

using namespace roomgraph::test;
using ::testing::HasSubstr;

std::vector<std::string> readAll(GzLines& lines) {
  std::vector<std::string> all;
  for (std::string line; lines.next(line);) all.push_back(line);
  return all;
}

// Lines of 0 to 3 blocks of the reader.
std::vector<std::string> someLines() {
  std::vector<std::string> lines;
  unsigned state = 1;
  for (const std::size_t length : {0u, 1u, 65535u, 65536u, 65537u, 200000u, 3u, 0u, 7u}) {
    std::string line;
    for (std::size_t i = 0; i < length; ++i)
      line += static_cast<char>('a' + (state = state * 1103515245u + 12345u) / 65536u % 26);
    lines.push_back(line);
  }
  return lines;
}

std::string joined(const std::vector<std::string>& lines) {
  std::string text;
  for (const auto& line : lines) text += line + "\n";
  return text;
}

TEST(GzLines, PlainAndGzippedGiveTheLinesThatWereWritten) {
  const TemporaryFolder folder;
  const auto lines = someLines();
  for (const auto& file :
       {folder.write("x.log", joined(lines)), writeGz(folder, "x.log.gz", joined(lines))}) {
    GzLines reader(file);
    EXPECT_EQ(readAll(reader), lines) << file;
    EXPECT_EQ(reader.number(), lines.size());
    EXPECT_EQ(reader.problem(), "");
    EXPECT_TRUE(reader.share() > 0.99);
  }
}

TEST(GzLines, LastLineNeedsNoEnd) {
  const TemporaryFolder folder;
  GzLines reader(folder.write("x.log", "one\ntwo"));
  EXPECT_EQ(readAll(reader), (std::vector<std::string>{"one", "two"}));
}

TEST(GzLines, CutOffIsToldAndItsBeginningRead) {
  const TemporaryFolder folder;
  const auto lines = someLines();
  writeGz(folder, "x.gz", joined(lines));
  const auto bytes = folder.read("x.gz");
  GzLines reader(folder.write("cut.gz", bytes.substr(0, bytes.size() / 2)));
  const auto read = readAll(reader);
  EXPECT_EQ(reader.problem(), "the gzip stream is cut off");
  ASSERT_GT(read.size(), 3u);
  for (std::size_t i = 0; i + 1 < read.size(); ++i) EXPECT_EQ(read[i], lines[i]);
  std::string damaged = bytes;
  for (std::size_t i = bytes.size() / 2; i < bytes.size() / 2 + 50; ++i) damaged[i] = '\0';
  GzLines broken(folder.write("damaged.gz", damaged));
  readAll(broken);
  EXPECT_EQ(broken.problem(), "the gzip stream is damaged");
}

TEST(GzLines, NoFileIsAnError) {
  const TemporaryFolder folder;
  EXPECT_THAT(messageOf<InputError>([&] { GzLines(folder.file("no.log")); }),
              HasSubstr("no.log: no such file"));
  EXPECT_THAT(messageOf<InputError>([&] { GzLines{folder.path()}; }), HasSubstr("is not a file"));
}

TEST(OrderedRecords, WithinTheWindowRecordsAreSorted) {
  std::vector<double> seen;
  OrderedRecords records(
      2, [&](const auto& record) { seen.push_back(std::round(10 * secondsOf(record)) / 10); });
  for (const double t : {10.0, 11.5, 10.5, 11.0, 13.0, 12.0, 10.2}) {
    auto odometry = mrpt::obs::CObservationOdometry::Create();
    odometry->timestamp = mrpt::Clock::fromDouble(t);
    odometry->sensorLabel = "W";
    records.push(odometry);
  }
  records.finish();
  EXPECT_EQ(seen, (std::vector<double>{10.0, 10.5, 11.0, 10.2, 11.5, 12.0, 13.0}));
  EXPECT_EQ(records.late(), 1) << "10.2 came when 11.0 had gone";
  EXPECT_EQ(records.written().at("W"), 7);
}

}  // namespace
}  // namespace roomgraph
