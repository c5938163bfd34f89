// SPDX-License-Identifier: BSD-3-Clause
// Films: clock, growth, lines of sight against a brute-force search, files that are read back.
#include "roomgraph/rendering/film.h"

#include <gmock/gmock.h>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/videoio.hpp>

#include "errors_of.h"
#include "map_history.h"
#include "picture.h"
#include "roomgraph/core/errors.h"
#include "sample_map.h"
#include "sight_times.h"
#include "temporary_folder.h"

namespace roomgraph {
namespace {

using test::TemporaryFolder;
using ::testing::HasSubstr;

ObjectDatabase noObjects() {
  return ObjectDatabase::fromText("[sofa]\nlabels = sofa\ncolor = #3f7fd0\n");
}

std::vector<StampedPose> pathAt(const std::vector<double>& times) {
  std::vector<StampedPose> path;
  for (const double t : times) path.push_back({t, poseFromYpr(t, 0, 0, 0, 0, 0)});
  return path;
}

FilmOptions smallFilm() {
  FilmOptions options;
  options.picture = {SnapshotView::kTop, 201, 150, ""};
  options.fps = 4;
  options.seconds = 2;
  return options;
}

const FilmProgress kToTheEnd = [](double) { return false; };

TEST(FilmClock, IsEvenButForPauses) {
  EXPECT_THAT(frameTimes(pathAt({10, 11, 12}), 0.5), ::testing::ElementsAre(10, 10.5, 11, 11.5, 12));
  // Two seconds of way and a pause of 98, which takes one.
  EXPECT_NEAR(timeOnTheWay(pathAt({0, 1, 99, 100})), 3, 1e-12);
  const auto times = frameTimes(pathAt({0, 1, 99, 100}), 0.5);
  ASSERT_EQ(times.size(), 7u);
  EXPECT_NEAR(times[2], 1, 1e-9);
  EXPECT_NEAR(times[3], 50, 1e-9) << "half of the pause";
  EXPECT_NEAR(times[4], 99, 1e-9);
  EXPECT_EQ(times.back(), 100);
  EXPECT_EQ(frameTimes(pathAt({0, 1}), 50).size(), 2u);
}

/// Whether a cell's centre is seen: many points on the line, none but the last ones in walls.
bool seesBySteps(const mrpt::maps::COccupancyGridMap2D& grid, const Eigen::Vector2d& from,
                 const Eigen::Vector2d& to) {
  const double length = (to - from).norm();
  for (double s = 0; s < length - 0.08; s += 0.005) {
    const Eigen::Vector2d p = from + (to - from) * (s / length);
    if (grid.getPos(static_cast<float>(p.x()), static_cast<float>(p.y())) < 0.35f) return false;
  }
  return true;
}

TEST(SightTimes, AgreeWithALineToEveryCell) {
  CSemanticMap map = test::sampleMap();
  auto& grid = *map.occupancy;
  for (int y = 0; y < 50; ++y) grid.setCell(60, y, 0.01f);  // a wall across at x = 2
  map.world_from_robot = {{1, poseFromYpr(0, -1, 0, 0, 0, 0)}, {5, poseFromYpr(4, -1, 0, 0, 0, 0)}};
  const auto times = sightTimes(map, 20);
  const int width = static_cast<int>(grid.getSizeX()), height = static_cast<int>(grid.getSizeY());
  ASSERT_EQ(times.size(), static_cast<std::size_t>(width * height));
  int wrong = 0, early = 0, late = 0, asked = 0;
  for (int y = 3; y < height - 3; ++y)
    for (int x = 3; x < width - 3; ++x) {
      const Eigen::Vector2d centre(-1 + (x + 0.5) * 0.05, -2 + (y + 0.5) * 0.05);
      const double expected = seesBySteps(grid, {0, -1}, centre)   ? 1
                              : seesBySteps(grid, {4, -1}, centre) ? 5
                                                                   : -1;
      if (expected < 0) continue;
      ++asked;
      const double found = times[static_cast<std::size_t>(y * width + x)];
      wrong += found != expected;
      (expected == 1 ? early : late) += 1;
    }
  EXPECT_GT(early, 1000);
  EXPECT_GT(late, 1000);
  EXPECT_LT(wrong, asked / 50) << "cells on the edge of the shadow";
}

TEST(MapHistory, ObjectsAppearAtTheirFirstSightingAndThePathGrows) {
  CSemanticMap map = test::sampleMap();  // stamps 1000 to 1003.9; objects 1, 2, 7
  map.seen[LandmarkId{1}] = {1001, 1003};
  const MapHistory history(map, {{1002.5, {LandmarkId{2}}}, {1001.5, {LandmarkId{2}, LandmarkId{1}}}});
  const auto idsAt = [&](double t) {
    std::vector<std::int64_t> ids;
    for (const auto& landmark : history.at(t).landmarks) ids.push_back(landmark.id.value);
    return ids;
  };
  EXPECT_THAT(idsAt(1000.5), ::testing::ElementsAre(7)) << "not known when: from the start";
  EXPECT_THAT(idsAt(1001), ::testing::ElementsAre(1, 7));
  EXPECT_THAT(idsAt(1001.5), ::testing::ElementsAre(1, 2, 7));
  EXPECT_EQ(history.at(1000.95).world_from_robot.size(), 10u);
  EXPECT_THAT(history.inSight(1001.6, 0.25), ::testing::ElementsAre(LandmarkId{1}, LandmarkId{2}));
  EXPECT_THAT(history.inSight(1001.8, 0.25), ::testing::IsEmpty());
  EXPECT_THAT(history.inSight(1001.4, 0.25), ::testing::IsEmpty());
}

TEST(MapHistory, TheFloorIsKnownOnceItWasInView) {
  CSemanticMap map = test::sampleMap();
  auto& grid = *map.occupancy;
  for (int y = 0; y < static_cast<int>(grid.getSizeY()); ++y)
    grid.setCell(60, y, 0.01f);  // all across at x = 2
  map.world_from_robot = {{1, poseFromYpr(0, -1, 0, 0, 0, 0)}, {5, poseFromYpr(4, -1, 0, 0, 0, 0)}};
  const MapHistory history(map, {});
  const auto at = [&](double t, float x) { return history.at(t).occupancy->getPos(x, -1.f); };
  EXPECT_EQ(at(1, 1.f), grid.getPos(1.f, -1.f));
  EXPECT_NEAR(at(4.9, 3.f), 0.5, 0.01) << "behind the wall";
  EXPECT_EQ(at(5, 3.f), grid.getPos(3.f, -1.f));
  EXPECT_LT(grid.getPos(2.01f, -1.f), 0.1) << "the map itself keeps its grid";
}

TEST(Film, EndsWithThePictureOfTheMapAndBeginsWithLess) {
  const TemporaryFolder folder;
  CSemanticMap map = test::sampleMap();
  for (const auto& landmark : map.landmarks) map.seen[landmark.id] = {1003, 1003};
  const auto result = writeFilm(map, {}, noObjects(), smallFilm(), folder.file("film"), kToTheEnd);
  EXPECT_EQ(result.frames, 9 + 6) << "two seconds and both ends, and a second and a half at the end";
  EXPECT_EQ(result.width, 200) << "even";
  ASSERT_EQ(std::distance(std::filesystem::directory_iterator(folder.file("film")), {}), result.frames);
  const cv::Mat first = cv::imread((folder.file("film") / "frame_00000.png").string()),
                last = cv::imread((folder.file("film") / "frame_00014.png").string());
  cv::Mat whole = renderPicture(map, noObjects(), smallFilm().picture);
  EXPECT_EQ(cv::norm(last, whole(cv::Rect(0, 0, 200, 150)), cv::NORM_INF), 0);
  EXPECT_GT(cv::norm(first, last, cv::NORM_INF), 80);
}

TEST(Film, StoppedEarlyItIsAShorterFilm) {
  const TemporaryFolder folder;
  const auto file = folder.file("x.avi");
  const auto result = writeFilm(test::sampleMap(), {}, noObjects(), smallFilm(), file,
                                [](double share) { return share > 0.3; });
  EXPECT_EQ(result.frames, 5);
  EXPECT_EQ(result.asked_for, 15);
  cv::VideoCapture video(file.string());
  ASSERT_TRUE(video.isOpened());
  cv::Mat frame;
  int frames = 0;
  for (; video.read(frame); ++frames) EXPECT_EQ(frame.size(), cv::Size(200, 150));
  EXPECT_EQ(frames, 5);
  EXPECT_EQ(folder.count(), 1u) << "nothing unfinished beside it";
}

TEST(Film, PaperStyleGrowsToo) {
  const TemporaryFolder folder;
  FilmOptions options = smallFilm();
  options.style = FigureStyle::kPaper;
  writeFilm(test::sampleMap(), {}, noObjects(), options, folder.file("film"), kToTheEnd);
  const cv::Mat first = cv::imread((folder.file("film") / "frame_00000.png").string()),
                last = cv::imread((folder.file("film") / "frame_00014.png").string());
  ASSERT_EQ(first.size(), last.size());
  EXPECT_GT(cv::norm(first, last, cv::NORM_INF), 80);
}

TEST(Film, SaysWhatItCannotDo) {
  const TemporaryFolder folder;
  const auto film = [&](const CSemanticMap& map, const std::string& place) {
    return test::messageOf<RunError>(
        [&] { writeFilm(map, {}, noObjects(), smallFilm(), folder.file(place), kToTheEnd); });
  };
  EXPECT_THAT(film(CSemanticMap(), "x.avi"), HasSubstr("no trajectory"));
  EXPECT_THAT(film(test::sampleMap(), "missing/x.avi"), HasSubstr("missing/x"));
  std::filesystem::create_directory(folder.file("full"));
  folder.write("full/frame_00000.png", "x");
  EXPECT_THAT(film(test::sampleMap(), "full"), HasSubstr("holds the frames of a film"));
  EXPECT_EQ(folder.read("full/frame_00000.png"), "x");
  folder.write("file", "x");
  EXPECT_THAT(film(test::sampleMap(), "file"), HasSubstr("cannot make the folder"));
}

TEST(Film, SightingsComeFromTheFileOfARun) {
  const TemporaryFolder folder;
  const auto file = folder.write(
      "associations.jsonl",
      R"({"timestamp": 2.5, "measurements": [{"class": "sofa", "bbox": [0, 0, 9, 9], "landmark": 4, "new": false}]})"
      "\n");
  const auto sightings = readSightings(file);
  ASSERT_EQ(sightings.size(), 1u);
  EXPECT_EQ(sightings[0].t, 2.5);
  EXPECT_THAT(sightings[0].landmarks, ::testing::ElementsAre(LandmarkId{4}));
}

}  // namespace
}  // namespace roomgraph
