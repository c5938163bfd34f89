// SPDX-License-Identifier: BSD-3-Clause
// Figures and floor plans: to scale, the same every time, symbols that differ without colour, pages that are
// too small.
#include "roomgraph/rendering/figure.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <map>
#include <opencv2/imgcodecs.hpp>
#include <sstream>

#include "canvas.h"
#include "errors_of.h"
#include "figure_legend.h"
#include "figure_picture.h"
#include "map_drawing.h"
#include "overlay.h"
#include "roomgraph/core/errors.h"
#include "roomgraph/rendering/floor_plan.h"
#include "sample_map.h"
#include "symbols.h"
#include "temporary_folder.h"

namespace roomgraph {
namespace {

using test::TemporaryFolder;
using ::testing::HasSubstr;
using ::testing::StartsWith;

ObjectDatabase furniture() {
  return ObjectDatabase::fromText(
      "[swivel_chair]\nlabels = chair\nshape = cylinder\ncolor = #e69f00\n"
      "[sofa]\nlabels = sofa\nshape = cuboid\ncolor = #0072b2\n"
      "[door]\nlabels = door\nshape = planar\ncolor = #d55e00\n"
      "[person]\nlabels = person\nshape = cylinder\nlandmark = false\ncolor = #c04070\n"
      "[stool]\nlabels = stool\nshape = cylinder\ncolor = #e69f00\n"
      "[bed]\nlabels = bed\nshape = cuboid\ncolor = #0072b2\n"
      "[table]\nlabels = table\nshape = cuboid\ncolor = #0072b2\n");
}

bool poppler() {
  return std::system("pdftoppm -v > /dev/null 2>&1") == 0;
}

/// A page by another program, in pixels.
cv::Mat pageOf(const TemporaryFolder& folder, const std::string& pdf, int dpi) {
  const std::string command = "pdftoppm -singlefile -png -r " + std::to_string(dpi) + " " +
                              folder.file(pdf).string() + " " + folder.file("page").string();
  EXPECT_EQ(std::system(command.c_str()), 0);
  return cv::imread(folder.file("page.png").string());
}

bool dark(const cv::Vec3b& pixel) {
  return std::max({pixel[0], pixel[1], pixel[2]}) < 60;
}

TEST(FloorPlan, ARoomOfSixMetresIsTwelveCentimetresWide) {
  if (!poppler()) GTEST_SKIP() << "pdftoppm (poppler-utils) is not installed";
  const TemporaryFolder folder;
  CSemanticMap map = test::sampleMap();  // 6 m x 4 m from outside to outside
  map.landmarks.clear();
  for (const double scale : {50.0, 25.0}) {
    EXPECT_EQ(writeFloorPlan(map, furniture(), {scale, "A3", "x"}, folder.file("plan.pdf")), "A3 landscape");
    const cv::Mat page = pageOf(folder, "plan.pdf", 254);  // ten pixels a millimetre
    ASSERT_NEAR(page.cols, 4200, 2);
    ASSERT_NEAR(page.rows, 2970, 2);
    // Along a row and a column through the room: the first and last dark pixel within the frame.
    const int row = (2970 - 300) / 2, column = 2100 + 300;
    int left = 5000, right = 0, top = 5000, bottom = 0;
    for (int u = 150; u < 4050; ++u)
      if (dark(page.at<cv::Vec3b>(row - 60, u))) left = std::min(left, u), right = std::max(right, u);
    for (int v = 150; v < 2500; ++v)
      if (dark(page.at<cv::Vec3b>(v, column))) top = std::min(top, v), bottom = std::max(bottom, v);
    EXPECT_NEAR(right + 1 - left, 6 / scale * 10000, 3);
    EXPECT_NEAR(bottom + 1 - top, 4 / scale * 10000, 3);
  }
}

/// Words of a page with their lower ends, in mm from above, as another program reads them.
std::map<std::string, double> wordsOf(const TemporaryFolder& folder, const std::string& pdf) {
  const std::string command =
      "pdftotext -bbox " + folder.file(pdf).string() + " " + folder.file("words.html").string();
  EXPECT_EQ(std::system(command.c_str()), 0);
  std::istringstream lines(folder.read("words.html"));
  std::map<std::string, double> out;
  for (std::string line; std::getline(lines, line);) {
    const auto y = line.find("yMax=\""), begin = line.find("\">"), end = line.find("</word>");
    if (y == std::string::npos || end == std::string::npos) continue;
    out[line.substr(begin + 2, end - begin - 2)] = std::stod(line.substr(y + 6)) / 72 * 25.4;
  }
  return out;
}

struct Word {
  std::string text;
  double x_min, y_min, x_max, y_max;  ///< pt, from above
};

/// Words of a page in the order of the file.
std::vector<Word> boxesOfWords(const TemporaryFolder& folder, const std::string& pdf) {
  wordsOf(folder, pdf);
  std::istringstream lines(folder.read("words.html"));
  std::vector<Word> out;
  for (std::string line; std::getline(lines, line);) {
    const auto number = [&](const std::string& name) {
      return std::stod(line.substr(line.find(name + "=\"") + name.size() + 2));
    };
    const auto begin = line.find("\">"), end = line.find("</word>");
    if (line.find("<word ") == std::string::npos || end == std::string::npos) continue;
    out.push_back({line.substr(begin + 2, end - begin - 2), number("xMin"), number("yMin"), number("xMax"),
                   number("yMax")});
  }
  return out;
}

/// The sample map with so many classes: kind0, kind1, …
CSemanticMap mapOfClasses(int count) {
  CSemanticMap map = test::sampleMap();
  const Landmark one = map.landmarks.front();
  map.landmarks.clear();
  for (int i = 0; i < count; ++i) {
    map.landmarks.push_back(one);
    map.landmarks.back().id = LandmarkId{i};
    map.landmarks.back().class_name = "kind" + std::to_string(i);
  }
  return map;
}

TEST(FloorPlan, TheBlockGrowsWithTheLegend) {
  if (!poppler()) GTEST_SKIP() << "pdftotext (poppler-utils) is not installed";
  const TemporaryFolder folder;
  for (const int count : {3, 12, 24}) {
    EXPECT_EQ(writeFloorPlan(mapOfClasses(count), furniture(), {50, "A4", ""}, folder.file("plan.pdf")),
              "A4 landscape");
    const auto words = wordsOf(folder, "plan.pdf");
    double scale = 0, lowest = 0;
    for (const auto& [word, y] : words) {
      if (word.starts_with("kind")) lowest = std::max(lowest, y);
      if (word == "50") scale = y;
    }
    for (int i = 0; i < count; ++i) EXPECT_TRUE(words.contains("kind" + std::to_string(i))) << count;
    EXPECT_LT(lowest, 210 - 10) << count << " classes: within the frame";
    EXPECT_LT(scale, 210 - 10);
    EXPECT_GT(lowest, 210 - 10 - 30 - (count > 12 ? 30 : 15));
  }
}

TEST(FloorPlan, WhatHasNoRoomIsCounted) {
  if (!poppler()) GTEST_SKIP() << "pdftotext (poppler-utils) is not installed";
  const TemporaryFolder folder;
  writeFloorPlan(mapOfClasses(150), furniture(), {100, "A4", ""}, folder.file("plan.pdf"));
  const auto words = wordsOf(folder, "plan.pdf");
  EXPECT_LT(words.at("more"), 210 - 10);
  int missing = -1, shown = 0;
  for (const auto& [word, y] : words) {
    if (std::all_of(word.begin(), word.end(), isdigit) && std::abs(y - words.at("more")) < 0.1)
      missing = std::stoi(word);
  }
  std::istringstream text(folder.read("words.html"));
  for (std::string line; std::getline(text, line);) shown += line.find(">(1)<") != std::string::npos;
  EXPECT_EQ(shown + missing, 150 + 3) << "obstacle, free, path stand at the end";
}

TEST(FloorPlan, TakesTheSmallestSheetAndSaysWhatFits) {
  const TemporaryFolder folder;
  CSemanticMap map = test::sampleMap();
  const auto plan = [&](double scale, const std::string& page) {
    return writeFloorPlan(map, furniture(), {scale, page, ""}, folder.file("plan.pdf"));
  };
  EXPECT_EQ(plan(50, "auto"), "A4 landscape");
  // With margins of .12 m less half a cell: 6.19 x 4.19 m; 28 mm of frame, 30 of title block.
  EXPECT_EQ(plan(23, "auto"), "A3 landscape");
  EXPECT_THAT(plan(5, "auto"), StartsWith("1266 x 89"));
  EXPECT_THAT(test::messageOf<RunError>([&] { plan(20, "A4"); }),
              HasSubstr("too large for A4: take --page A3 or --scale 50"))
      << "at 1 : 25 the room is 168 mm deep, and A4 has 152 for it";
  EXPECT_THAT(test::messageOf<RunError>([&] { plan(1, "auto"); }), HasSubstr("too large for A0"));
  map.occupancy.reset();
  map.landmarks.clear();
  map.world_from_robot = {{0, poseFromYpr(0, 0, 0, 0, 0, 0)}, {1, poseFromYpr(0, 9, 0, 0, 0, 0)}};
  EXPECT_EQ(plan(50, "auto"), "A4 portrait");
  EXPECT_THAT(test::messageOf<RunError>(
                  [&] { writeFloorPlan(CSemanticMap(), furniture(), {}, folder.file("plan.pdf")); }),
              HasSubstr("empty"));
}

TEST(Figure, TheSameMapGivesTheSameBytesInEveryFormat) {
  const TemporaryFolder folder;
  for (const auto style : {FigureStyle::kScreen, FigureStyle::kPaper}) {
    for (const auto& [ending, begin] :
         std::map<std::string, std::string>{{".pdf", "%PDF-1"}, {".svg", "<?xml"}, {".png", "\x89PNG"}}) {
      writeFigure(test::sampleMap(), furniture(), {style, 640, 480, "A room"}, folder.file("a" + ending));
      writeFigure(test::sampleMap(), furniture(), {style, 640, 480, "A room"}, folder.file("b" + ending));
      EXPECT_THAT(folder.read("a" + ending), StartsWith(begin));
      EXPECT_TRUE(folder.read("a" + ending) == folder.read("b" + ending)) << ending;
    }
  }
  EXPECT_THROW(writeFigure(test::sampleMap(), furniture(), {}, folder.file("a.gif")), std::invalid_argument);
}

TEST(Figure, PdfAndPixelsShowTheSame) {
  if (!poppler()) GTEST_SKIP() << "pdftoppm (poppler-utils) is not installed";
  const TemporaryFolder folder;
  for (const auto style : {FigureStyle::kScreen, FigureStyle::kPaper}) {
    const FigureOptions options{style, 640, 480, "A room"};
    writeFigure(test::sampleMap(), furniture(), options, folder.file("a.pdf"));
    const cv::Mat page = pageOf(folder, "a.pdf", 96),
                  own = figurePixels(test::sampleMap(), furniture(), options);
    ASSERT_LE(std::abs(page.rows - own.rows), 1);
    const cv::Rect both(0, 0, std::min(page.cols, own.cols), std::min(page.rows, own.rows));
    EXPECT_LT(cv::norm(page(both), own(both), cv::NORM_L1) / (3.0 * both.area()), 3) << "mean of 255";
  }
}

TEST(Figure, PaperEndsWhereTheMapEndsAndScreenHasTheSizeAskedFor) {
  const auto size = [](FigureStyle style) {
    return figurePixels(test::sampleMap(), furniture(), {style, 800, 800, ""}).size();
  };
  EXPECT_EQ(size(FigureStyle::kScreen), cv::Size(800, 800));
  EXPECT_EQ(size(FigureStyle::kPaper).width, 800);
  const TemporaryFolder folder;
  for (const char* name : {"a.png", "a.pdf"}) {
    const auto told =
        writeFigure(test::sampleMap(), furniture(), {FigureStyle::kPaper, 800, 800, ""}, folder.file(name));
    EXPECT_EQ(cv::Size(told.width, told.height), size(FigureStyle::kPaper)) << name;
  }
  EXPECT_LT(size(FigureStyle::kPaper).height, 640) << "the room is 6 m x 4 m";
}

// A film whose tenth chair needs another row of the legend.
TEST(Figure, PartsOfAMapHaveTheLayoutOfTheWhole) {
  CSemanticMap whole = mapOfClasses(4);
  for (auto& landmark : whole.landmarks) landmark.class_name = "kind" + std::to_string(landmark.id.value % 2);
  while (whole.landmarks.size() < 12) {
    whole.landmarks.push_back(whole.landmarks.front());
    whole.landmarks.back().id = LandmarkId{static_cast<int>(whole.landmarks.size())};
  }
  CSemanticMap part = whole;
  part.landmarks.resize(2);
  for (const FigureStyle style : {FigureStyle::kPaper, FigureStyle::kScreen})
    for (int width = 200; width < 700; width += 2) {
      const FigureOptions options{style, width, 300, ""};
      ASSERT_EQ(figurePixels({part, whole}, furniture(), options).size(), figurePixels(whole, furniture(), options).size()) << width;
    }
  for (int width = 200; width < 700; width += 2) {
    const SnapshotOptions options{SnapshotView::kTop, width, 300, ""};
    ASSERT_EQ(mapArea({part, whole}, furniture(), options), mapArea(whole, furniture(), options)) << width;
  }
}

TEST(Figure, TheLegendEndsBeforeTheScaleBar) {
  if (!poppler()) GTEST_SKIP() << "pdftotext (poppler-utils) is not installed";
  const TemporaryFolder folder;
  for (const float width_m : {4.2f, 8.3f, 17.f, 21.f}) {
    CSemanticMap map = mapOfClasses(9);
    map.occupancy = mrpt::maps::COccupancyGridMap2D::Create(-1.f, width_m - 1, -2.f, width_m / 2 - 2, 0.1f);
    map.occupancy->fill(0.9f);
    for (const auto style : {FigureStyle::kScreen, FigureStyle::kPaper}) {
      writeFigure(map, furniture(), {style, 640, 480, ""}, folder.file("a.pdf"));
      const auto words = boxesOfWords(folder, "a.pdf");
      const auto bar =
          std::find_if(words.rbegin(), words.rend(), [](const Word& w) { return w.text == "0"; });
      ASSERT_NE(bar, words.rend());
      for (const Word& word : words)
        if (word.text.starts_with("(")) {
          EXPECT_TRUE(word.x_max < bar->x_min || word.y_min > bar->y_max + 4)
              << width_m << " m: " << word.text;
        }
    }
  }
}

TEST(Figure, ThePathIsNotDrawnAcrossAGap) {
  const auto at = [](double from_x, double to_x) {
    CSemanticMap map = test::sampleMap();
    map.landmarks.clear();
    map.world_from_robot.clear();
    for (const auto& [begin, end] : {std::pair{-0.5, from_x}, std::pair{to_x, 4.5}})
      for (double x = begin; x <= end; x += 0.1)
        map.world_from_robot.push_back({100 + x, poseFromYpr(x, 0, 0, 0, 0, 0)});
    const cv::Mat image = figurePixels(map, furniture(), {FigureStyle::kPaper, 640, 480, ""});
    cv::Mat channels[3];
    cv::split(image, channels);
    return cv::countNonZero(channels[0] - channels[1] > 60);  // violet among greys
  };
  const int whole = at(1.9, 2.0), gap = at(0.5, 3.5);
  EXPECT_LT(gap, 0.6 * whole);
  EXPECT_GT(gap, 0.2 * whole);
}

TEST(Figure, TakesAnyBytesForATitleAndMapsWithoutAnything) {
  const TemporaryFolder folder;
  for (const std::string title :
       {"caf\xc3\xa9 \xe2\x82\xac", "broken \xff\xc3", "\xed\xa0\x80", "line\nbreak", "<&>\""})
    for (const char* ending : {"a.pdf", "a.svg", "a.png"})
      EXPECT_NO_THROW(writeFigure(test::sampleMap(), furniture(), {FigureStyle::kPaper, 320, 240, title},
                                  folder.file(ending)));
  for (const char* ending : {"a.pdf", "a.svg", "a.png"})
    EXPECT_NO_THROW(writeFigure(CSemanticMap(), furniture(), {}, folder.file(ending)));
}

/// One object alone on white, 10 px a pt of the page, without colour.
cv::Mat grey(const std::string& class_name, ShapeKind kind, bool has_yaw) {
  Canvas canvas(CanvasFormat::kPixels, {150, 150});
  canvas.area({Polygon2{{0, 0}, {150, 0}, {150, 150}, {0, 150}}}, palette::kFree);
  drawSymbol(canvas, symbolOf(furniture(), class_name), {kind, 1, kind == ShapeKind::kPlanar ? 0.1 : 0.8, 1},
             has_yaw, FigureStyle::kPaper,
             [](const Eigen::Vector2d& at) { return Eigen::Vector2d(75 + 100 * at.y(), 75 + 100 * at.x()); });
  cv::Mat channel;
  cv::extractChannel(canvas.pixels(), channel, 1);
  return channel;
}

TEST(Symbols, ClassesDifferWithoutColour) {
  const std::vector<cv::Mat> symbols{grey("swivel_chair", ShapeKind::kCylinder, false),
                                     grey("stool", ShapeKind::kCylinder, false),
                                     grey("sofa", ShapeKind::kCuboid, true),
                                     grey("bed", ShapeKind::kCuboid, true),
                                     grey("table", ShapeKind::kCuboid, true),
                                     grey("unheard of", ShapeKind::kCuboid, true),
                                     grey("door", ShapeKind::kPlanar, true)};
  for (std::size_t i = 0; i < symbols.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      cv::Mat apart = cv::abs(symbols[i] - symbols[j]);
      EXPECT_GT(cv::countNonZero(apart > 40), 300) << i << " and " << j;
    }
}

TEST(Symbols, ADoorIsDashed) {
  const cv::Mat door = grey("door", ShapeKind::kPlanar, true);
  int changes = 0;
  const int row = door.rows / 2;
  for (int u = 1; u < door.cols; ++u)
    changes += (door.at<uchar>(row, u) < 170) != (door.at<uchar>(row, u - 1) < 170);
  EXPECT_GE(changes, 2 * 100 / 6) << "a dash and a gap are 5.8 pt of 100";
}

TEST(Legend, RowsTakeWhatThereIsAndTheScaleBarIsRound) {
  Canvas canvas(CanvasFormat::kPixels, {8, 8});
  const auto entries = legendOf(test::sampleMap(), furniture(), FigureStyle::kPaper);
  ASSERT_EQ(entries.size(), 6u) << "three classes, obstacle, free, path";
  EXPECT_EQ(entries[2].text, "swivel chair (1)");
  EXPECT_EQ(legendRows(canvas, entries, 1e6), 1);
  EXPECT_EQ(legendRows(canvas, entries, 1), 6);
  double widest = 0, all = 0;
  for (const auto& entry : entries) {
    const double width = entry.width + 20 + canvas.textWidth(entry.text, {kLegendText_pt});
    widest = std::max(widest, width), all += width;
  }
  EXPECT_GE(legendRows(canvas, entries, all / 2), 2);
  for (const double width : {0.7, 6.0, 14.1, 50.0, 333.0}) {
    const double bar = scaleBarLength(width), digit = bar / std::pow(10, std::floor(std::log10(bar) + 1e-9));
    EXPECT_TRUE(std::abs(digit - 1) < 1e-9 || std::abs(digit - 2) < 1e-9 || std::abs(digit - 5) < 1e-9)
        << bar;
    EXPECT_GT(bar, width / 8);
    EXPECT_LT(bar, width / 3.1);
  }
}

}  // namespace
}  // namespace roomgraph
