// SPDX-License-Identifier: BSD-3-Clause
// Trajectory reader: TUM and planar format, sorting, malformed lines.
#include "roomgraph/evaluation/trajectory_file.h"

#include <gmock/gmock.h>

#include "errors_of.h"
#include "roomgraph/core/errors.h"
#include "temporary_folder.h"

namespace roomgraph {
namespace {

using ::testing::HasSubstr;
using test::messageOf;
using test::TemporaryFolder;

TEST(TrajectoryFile, ReadsTumFormatWithCommentsAndSeparators) {
  const TemporaryFolder folder;
  const auto file = folder.write("a.txt",
                                 "# timestamp tx ty tz qx qy qz qw\n\n"
                                 "10.5 1 2 3 0 0 0.70710678 0.70710678\r\n"
                                 "  11.5,-1e-1,+2.5,3,0,0,0,1\n% end\n");
  const auto read = readTrajectory(file);
  ASSERT_EQ(read.trajectory.size(), 2u);
  EXPECT_EQ(read.trajectory.poses()[0].t, 10.5);
  // Quarter turn about z: x goes to y.
  EXPECT_TRUE(
      (read.trajectory.poses()[0].pose * Eigen::Vector3d(1, 0, 0)).isApprox(Eigen::Vector3d(1, 3, 3), 1e-7));
  EXPECT_TRUE(read.trajectory.poses()[1].pose.translation().isApprox(Eigen::Vector3d(-0.1, 2.5, 3)));
  EXPECT_TRUE(read.sorted);
  EXPECT_FALSE(read.planar);
  EXPECT_EQ(read.duplicates, 0);
}

TEST(TrajectoryFile, ReadsFourColumnsAsPlanar) {
  const TemporaryFolder folder;
  const auto read = readTrajectory(folder.write("a.txt", "1 2 3 1.5707963267948966\n"));
  EXPECT_TRUE(read.planar);
  const Pose3& pose = read.trajectory.poses()[0].pose;
  EXPECT_TRUE((pose * Eigen::Vector3d(1, 0, 0)).isApprox(Eigen::Vector3d(2, 4, 0), 1e-12));
}

TEST(TrajectoryFile, SortsAndDropsRepeatedStamps) {
  const TemporaryFolder folder;
  const auto read = readTrajectory(folder.write("a.txt", "3 3 0 0\n1 1 0 0\n3 9 0 0\n2 2 0 0\n1 1 0 0\n"));
  ASSERT_EQ(read.trajectory.size(), 3u);
  EXPECT_FALSE(read.sorted);
  EXPECT_EQ(read.duplicates, 2);
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(read.trajectory.poses()[static_cast<std::size_t>(i)].t, i + 1);
    EXPECT_EQ(read.trajectory.poses()[static_cast<std::size_t>(i)].pose.translation().x(),
              i + 1);  // the first wins
  }
}

TEST(TrajectoryFile, BadLinesAreInputErrorsWithFileAndLine) {
  const struct {
    const char *text, *place, *words;
  } cases[] = {{"", "", "holds no pose"},
               {"# only\n", "", "holds no pose"},
               {"1 2 3\n", ":1", "got 3"},
               {"# c\n1 2 3 4 5\n", ":2", "got 5"},
               {"1 2 3 0\n2 x 3 0\n", ":2", "'x' is not a finite number"},
               {"1 2 3 nan\n", ":1", "'nan'"},
               {"1 2 3 inf\n", ":1", "'inf'"},
               {"1 2 3 4abc\n", ":1", "'4abc'"},
               {"1 2 3 0\n2 0 0 0 0 0 0 1\n", ":2", "has 8 columns"},
               {"1 0 0 0 0 0 0 0\n", ":1", "quaternion has norm"},
               {"1 0 0 0 1 1 1 1\n", ":1", "quaternion has norm 2"}};
  const TemporaryFolder folder;
  for (const auto& c : cases) {
    SCOPED_TRACE(c.text);
    const auto file = folder.write("bad.txt", c.text);
    const auto message = messageOf<InputError>([&] { readTrajectory(file); });
    EXPECT_THAT(message, HasSubstr(file.string() + c.place));
    EXPECT_THAT(message, HasSubstr(c.words));
  }
}

TEST(TrajectoryFile, MissingFileAndFolderAreInputErrors) {
  const TemporaryFolder folder;
  EXPECT_THAT(messageOf<InputError>([&] { readTrajectory(folder.path() / "none.txt"); }),
              HasSubstr("none.txt"));
  EXPECT_THAT(messageOf<InputError>([&] { readTrajectory(folder.path()); }), HasSubstr("cannot be opened"));
}

}  // namespace
}  // namespace roomgraph
