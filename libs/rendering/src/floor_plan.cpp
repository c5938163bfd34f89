// SPDX-License-Identifier: BSD-3-Clause
// Choice of the sheet, frame, title block.
#include "roomgraph/rendering/floor_plan.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>

#include "canvas.h"
#include "figure_legend.h"
#include "map_drawing.h"
#include "overlay.h"
#include "roomgraph/core/errors.h"
#include "roomgraph/core/output_file.h"

namespace roomgraph {
namespace {

constexpr double kFrame_mm = 10;   ///< from the edge of the sheet to the frame: printers need some of it
constexpr double kPadding_mm = 4;  ///< from the frame to the map
constexpr double kLeastBlock_mm = 30;    ///< title block and legend at the bottom
constexpr double kMostBlockShare = 0.4;  ///< of the sheet's height, however many classes there are
constexpr double kLegendShare = 0.55;    ///< of the width within the frame
constexpr double kLegendPadding_mm = 2;
constexpr double kLargestPdf_mm = 5080;  ///< 200 inch

struct Sheet {
  std::string name;
  Eigen::Vector2d size;  ///< mm
};

/// ISO 216, upright, the smallest first.
const std::vector<Sheet>& isoSheets() {
  static const std::vector<Sheet> sheets{
      {"A4", {210, 297}}, {"A3", {297, 420}}, {"A2", {420, 594}}, {"A1", {594, 841}}, {"A0", {841, 1189}}};
  return sheets;
}

/// What is to go on a sheet.
struct Content {
  Eigen::Vector2d world_m;
  std::function<double(double)> block_mm;  ///< height of the block on a sheet of that width (mm)

  /// Size of the map, mm.
  Eigen::Vector2d map(double scale) const { return world_m * 1000 / scale; }
};

/// The smallest sheet of that width around a map of this size, mm.
Eigen::Vector2d sheetAround(const Eigen::Vector2d& map, double width, const Content& content) {
  return map + Eigen::Vector2d(2 * (kFrame_mm + kPadding_mm),
                               2 * (kFrame_mm + kPadding_mm) + content.block_mm(width));
}

double blockOn(const Eigen::Vector2d& sheet, const Content& content) {
  return std::min(content.block_mm(sheet.x()), std::max(kLeastBlock_mm, kMostBlockShare * sheet.y()));
}

bool holds(const Eigen::Vector2d& sheet, const Eigen::Vector2d& map, const Content& content) {
  const Eigen::Vector2d room = sheet - Eigen::Vector2d::Constant(2 * (kFrame_mm + kPadding_mm)) -
                               Eigen::Vector2d(0, blockOn(sheet, content));
  return (room.array() + 1e-6 >= map.array()).all();
}

/// Upright or lying, upright first for maps that are taller than wide; nothing when the map is too large.
std::optional<Sheet> turned(const Sheet& sheet, const Content& content, double scale) {
  const Eigen::Vector2d map = content.map(scale);
  const Sheet portrait{sheet.name + " portrait", sheet.size},
      landscape{sheet.name + " landscape", {sheet.size.y(), sheet.size.x()}};
  const bool tall = map.y() > map.x();
  for (const Sheet& one : {tall ? portrait : landscape, tall ? landscape : portrait})
    if (holds(one.size, map, content)) return one;
  return std::nullopt;
}

std::string millimetres(const Eigen::Vector2d& size) {
  return std::to_string(std::lround(size.x())) + " x " + std::to_string(std::lround(size.y())) + " mm";
}

/// The next scale of the usual ones at which the map fits.
std::string fittingScale(const Sheet& sheet, const Content& content) {
  for (double power = 10;; power *= 10)
    for (const double digit : {1.0, 2.0, 2.5, 5.0})
      if (turned(sheet, content, digit * power)) return std::to_string(std::lround(digit * power));
}

[[noreturn]] void refuse(const Sheet& asked, const Content& content, double scale) {
  std::string larger;
  for (const Sheet& sheet : isoSheets())
    if (larger.empty() && turned(sheet, content, scale)) larger = "--page " + sheet.name + " or ";
  throw RunError("at 1 : " + std::to_string(std::lround(scale)) + " the map is " +
                 millimetres(content.map(scale)) + ", too large for " + asked.name + ": take " + larger +
                 "--scale " + fittingScale(asked, content));
}

Sheet sheetFor(const Content& content, const FloorPlanOptions& options) {
  for (const Sheet& sheet : isoSheets()) {
    if (options.page != "auto" && options.page != sheet.name) continue;
    if (const auto found = turned(sheet, content, options.scale)) return *found;
    if (options.page == sheet.name) refuse(sheet, content, options.scale);
  }
  const Eigen::Vector2d map = content.map(options.scale);
  const Eigen::Vector2d size =
      (sheetAround(map, map.x() + 2 * (kFrame_mm + kPadding_mm), content).array() - 1e-6).ceil();
  if (size.maxCoeff() > kLargestPdf_mm) refuse(isoSheets().back(), content, options.scale);
  return {millimetres(size), size};
}

std::string dateOf(const CSemanticMap& map) {
  if (map.world_from_robot.empty() || map.world_from_robot.front().t < 86400) return "";
  const auto seconds = static_cast<std::time_t>(map.world_from_robot.front().t);
  std::tm parts{};
  gmtime_r(&seconds, &parts);
  char text[48];
  std::strftime(text, sizeof text, "recorded %Y-%m-%d", &parts);
  return text;
}

double legendWidth_pt(double sheet_width_mm) {
  return (kLegendShare * (sheet_width_mm - 2 * kFrame_mm) - 5) * kPointsPerMillimeter;
}

double blockFor_mm(int rows) {
  return std::max(kLeastBlock_mm, rows * kLegendRow_pt / kPointsPerMillimeter + 2 * kLegendPadding_mm);
}

/// As many entries as have room; the last says how many have none.
std::vector<LegendEntry> fitting(Canvas& canvas, std::vector<LegendEntry> entries, double width_pt,
                                 double block_mm) {
  const auto fits = [&] { return blockFor_mm(legendRows(canvas, entries, width_pt)) <= block_mm + 1e-6; };
  const auto all = entries;
  for (std::size_t kept = all.size(); !fits() && kept > 0;) {
    entries.assign(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(--kept));
    entries.push_back({"and " + std::to_string(all.size() - kept) + " more", 0, [](Canvas&, const auto&) {}});
  }
  return entries;
}

/// Legend at the left; title, facts, scale and scale bar at the right.
void drawBlock(Canvas& canvas, const CSemanticMap& map, const ObjectDatabase& database,
               const FloorPlanOptions& options, const PagePlace& place, double block_mm) {
  const double mm = kPointsPerMillimeter, edge = kFrame_mm * mm;
  const Eigen::Vector2d size = canvas.size();
  const double top = size.y() - edge - block_mm * mm, middle = edge + kLegendShare * (size.x() - 2 * edge),
               width = legendWidth_pt(size.x() / mm);
  canvas.line(
      {{edge, edge}, {size.x() - edge, edge}, {size.x() - edge, size.y() - edge}, {edge, size.y() - edge}},
      {palette::kInk, 0.7}, true);
  canvas.line({{edge, top}, {size.x() - edge, top}}, {palette::kInk, 0.5});
  canvas.line({{middle, top}, {middle, size.y() - edge}}, {palette::kInk, 0.5});
  drawLegend(canvas, fitting(canvas, legendOf(map, database, FigureStyle::kPaper), width, block_mm),
             {edge + 3 * mm, top + kLegendPadding_mm * mm}, width);
  const double left = middle + 4 * mm;
  canvas.text({left, top + 7 * mm}, options.title.empty() ? "Floor plan" : options.title, {11});
  canvas.text({left, top + 12 * mm}, factsOf(map), {7.5, palette::kFaintInk});
  canvas.text({left, top + 16 * mm}, dateOf(map), {7.5, palette::kFaintInk});
  canvas.text({left, size.y() - edge - 4 * mm}, "1 : " + std::to_string(std::lround(options.scale)), {12});
  drawScaleBar(canvas, scaleBarLength(40 * options.scale / 1000 * 5), place.points_per_m,
               {size.x() - edge - 9 * mm, size.y() - edge - 4 * mm});
}

}  // namespace

const std::vector<std::string>& pageNames() {
  static const std::vector<std::string> names{"auto", "A4", "A3", "A2", "A1", "A0"};
  return names;
}

std::string writeFloorPlan(const CSemanticMap& map, const ObjectDatabase& database,
                           const FloorPlanOptions& options, const std::filesystem::path& pdf) {
  if (!map.occupancy && map.landmarks.empty() && map.world_from_robot.empty())
    throw RunError("the map is empty: there is nothing to draw");
  PagePlace place{drawnWorld(map)};
  Canvas ruler(CanvasFormat::kPdf, {1, 1});
  const auto legend = legendOf(map, database, FigureStyle::kPaper);
  const Content content{place.world.sizes(), [&](double sheet_width_mm) {
                          return blockFor_mm(legendRows(ruler, legend, legendWidth_pt(sheet_width_mm)));
                        }};
  const Sheet sheet = sheetFor(content, options);
  const double block_mm = blockOn(sheet.size, content);
  const double mm = kPointsPerMillimeter;
  place.points_per_m = 1000 / options.scale * mm;
  const Eigen::Vector2d page = sheet.size * mm;
  Canvas canvas(CanvasFormat::kPdf, page, options.title,
                map.world_from_robot.empty() ? 0 : map.world_from_robot.front().t);
  const Eigen::Vector2d room = page - Eigen::Vector2d(0, block_mm * mm);
  place.corner = (room - place.size()) / 2;
  drawMap(canvas, map, database, FigureStyle::kPaper, ObjectNames::kClassAndNumber, place);
  drawBlock(canvas, map, database, options, place, block_mm);
  writeFileAtomically(pdf, canvas.finishedFile());
  return sheet.name;
}

}  // namespace roomgraph
