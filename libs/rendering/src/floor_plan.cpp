// SPDX-License-Identifier: BSD-3-Clause
// Choice of the sheet, frame, title block.
#include "roomgraph/rendering/floor_plan.h"

#include <algorithm>
#include <cmath>
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
constexpr double kBlock_mm = 30;   ///< title block and legend at the bottom
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

/// What the map of this size (mm) leaves no room for.
Eigen::Vector2d sheetAround(const Eigen::Vector2d& map) {
  return map + Eigen::Vector2d(2 * (kFrame_mm + kPadding_mm), 2 * (kFrame_mm + kPadding_mm) + kBlock_mm);
}

bool holds(const Eigen::Vector2d& sheet, const Eigen::Vector2d& map) {
  return (sheet.array() + 1e-6 >= sheetAround(map).array()).all();
}

/// Upright or lying, upright first for maps that are taller than wide; nothing when the map is too large.
std::optional<Sheet> turned(const Sheet& sheet, const Eigen::Vector2d& map) {
  const Sheet portrait{sheet.name + " portrait", sheet.size},
      landscape{sheet.name + " landscape", {sheet.size.y(), sheet.size.x()}};
  const bool tall = map.y() > map.x();
  for (const Sheet& one : {tall ? portrait : landscape, tall ? landscape : portrait})
    if (holds(one.size, map)) return one;
  return std::nullopt;
}

std::string millimetres(const Eigen::Vector2d& size) {
  return std::to_string(std::lround(size.x())) + " x " + std::to_string(std::lround(size.y())) + " mm";
}

/// The next scale of the usual ones at which the map fits.
std::string fittingScale(const Sheet& sheet, const Eigen::Vector2d& world_m) {
  for (double power = 10;; power *= 10)
    for (const double digit : {1.0, 2.0, 2.5, 5.0})
      if (turned(sheet, world_m * 1000 / (digit * power))) return std::to_string(std::lround(digit * power));
}

[[noreturn]] void refuse(const Sheet& asked, const Eigen::Vector2d& world_m, double scale) {
  const Eigen::Vector2d map = world_m * 1000 / scale;
  std::string larger;
  for (const Sheet& sheet : isoSheets())
    if (larger.empty() && turned(sheet, map)) larger = "--page " + sheet.name + " or ";
  throw RunError("at 1 : " + std::to_string(std::lround(scale)) + " the map is " + millimetres(map) +
                 ", too large for " + asked.name + ": take " + larger + "--scale " +
                 fittingScale(asked, world_m));
}

Sheet sheetFor(const Eigen::Vector2d& world_m, const FloorPlanOptions& options) {
  const Eigen::Vector2d map = world_m * 1000 / options.scale;
  for (const Sheet& sheet : isoSheets()) {
    if (options.page != "auto" && options.page != sheet.name) continue;
    if (const auto found = turned(sheet, map)) return *found;
    if (options.page == sheet.name) refuse(sheet, world_m, options.scale);
  }
  const Eigen::Vector2d size = (sheetAround(map).array() - 1e-6).ceil();
  if (size.maxCoeff() > kLargestPdf_mm) refuse(isoSheets().back(), world_m, options.scale);
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

/// Legend at the left; title, facts, scale and scale bar at the right.
void drawBlock(Canvas& canvas, const CSemanticMap& map, const ObjectDatabase& database,
               const FloorPlanOptions& options, const PagePlace& place) {
  const double mm = kPointsPerMillimeter, edge = kFrame_mm * mm;
  const Eigen::Vector2d size = canvas.size();
  const double top = size.y() - edge - kBlock_mm * mm, middle = edge + 0.55 * (size.x() - 2 * edge);
  canvas.line(
      {{edge, edge}, {size.x() - edge, edge}, {size.x() - edge, size.y() - edge}, {edge, size.y() - edge}},
      {palette::kInk, 0.7}, true);
  canvas.line({{edge, top}, {size.x() - edge, top}}, {palette::kInk, 0.5});
  canvas.line({{middle, top}, {middle, size.y() - edge}}, {palette::kInk, 0.5});
  drawLegend(canvas, legendOf(map, database, FigureStyle::kPaper), {edge + 3 * mm, top + 2 * mm},
             middle - edge - 5 * mm);
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
  const Sheet sheet = sheetFor(place.world.sizes(), options);
  const double mm = kPointsPerMillimeter;
  place.points_per_m = 1000 / options.scale * mm;
  const Eigen::Vector2d page = sheet.size * mm;
  Canvas canvas(CanvasFormat::kPdf, page, options.title,
                map.world_from_robot.empty() ? 0 : map.world_from_robot.front().t);
  const Eigen::Vector2d room = page - Eigen::Vector2d(0, kBlock_mm * mm);
  place.corner = (room - place.size()) / 2;
  drawMap(canvas, map, database, FigureStyle::kPaper, ObjectNames::kClassAndNumber, place);
  drawBlock(canvas, map, database, options, place);
  writeFileAtomically(pdf, canvas.finishedFile());
  return sheet.name;
}

}  // namespace roomgraph
