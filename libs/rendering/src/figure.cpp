// SPDX-License-Identifier: BSD-3-Clause
// Layout of a figure: title, map, legend, scale bar.
#include "roomgraph/rendering/figure.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgcodecs.hpp>

#include "canvas.h"
#include "figure_legend.h"
#include "figure_picture.h"
#include "map_drawing.h"
#include "overlay.h"
#include "roomgraph/core/output_file.h"

namespace roomgraph {
namespace {

constexpr double kEdge_pt = 14, kTitle_pt = 13, kTitleSpace_pt = 34, kAboveLegend_pt = 10;
constexpr double kWidestLegend = 0.76;  ///< of the width
constexpr double kBeforeBar_pt = 18;    ///< from the legend to the scale bar, whose figures stick out

struct Layout {
  Eigen::Vector2d size;  ///< of the page, pt
  PagePlace place;
  std::vector<LegendEntry> legend;
  double legend_top = 0, legend_width = 0, bar_m = 0;
};

/// The map as large as fits into this width and what title and legend leave of the height.
Layout layoutFor(const MapPicture& picture, const ObjectDatabase& database, const FigureOptions& options,
                 double width) {
  // Words have the same width on every canvas.
  Canvas ruler(CanvasFormat::kPixels, {8, 8});
  Layout layout;
  layout.place.world = drawnWorld(picture.whole);
  layout.legend = legendOf(picture, database, options.style);
  layout.bar_m = scaleBarLength(layout.place.world.sizes().x());
  const double height = options.height * kPointsPerPixel, inside = width - 2 * kEdge_pt;
  const double top = kEdge_pt + (options.title.empty() ? 0 : kTitleSpace_pt);
  const double longest_bar = inside * layout.bar_m / layout.place.world.sizes().x();
  layout.legend_width = std::min(kWidestLegend * inside, inside - longest_bar - kBeforeBar_pt);
  const double below = kAboveLegend_pt + kEdge_pt +
                       kLegendRow_pt * std::max(1, legendRows(ruler, layout.legend, layout.legend_width));
  const Eigen::Vector2d room(inside, std::max(height - top - below, 8.0));
  layout.place.points_per_m = room.cwiseQuotient(layout.place.world.sizes()).minCoeff();
  const Eigen::Vector2d drawn = layout.place.size();
  const bool cropped = options.style == FigureStyle::kPaper;
  layout.size = {width, cropped ? top + drawn.y() + below : height};
  layout.place.corner = {kEdge_pt + (inside - drawn.x()) / 2,
                         top + (cropped ? 0 : (room.y() - drawn.y()) / 2)};
  layout.legend_top = layout.size.y() - below + kAboveLegend_pt;
  return layout;
}

/// Paper: no wider than the map, but for a legend that needs some width.
Layout layoutOf(const MapPicture& picture, const ObjectDatabase& database, const FigureOptions& options) {
  const double width = options.width * kPointsPerPixel;
  const auto whole_pixels = [](double points) {
    return std::ceil(points / kPointsPerPixel) * kPointsPerPixel;
  };
  const Layout wide = layoutFor(picture, database, options, width);
  if (options.style != FigureStyle::kPaper) return wide;
  Layout layout =
      layoutFor(picture, database, options,
                whole_pixels(std::clamp(wide.place.size().x() + 2 * kEdge_pt, 0.5 * width, width)));
  layout.size.y() = whole_pixels(layout.size.y());
  return layout;
}

void drawFigure(Canvas& canvas, const MapPicture& picture, const ObjectDatabase& database,
                const FigureOptions& options, const Layout& layout) {
  const Eigen::Vector2d size = canvas.size();
  canvas.area({{{0, 0}, {size.x(), 0}, size, {0, size.y()}}}, shadesOf(options.style).page);
  drawMap(canvas, picture, database, options.style,
          options.style == FigureStyle::kPaper ? ObjectNames::kNumber : ObjectNames::kClassAndNumber,
          layout.place);
  if (!options.title.empty()) {
    canvas.text({kEdge_pt, kEdge_pt + kTitle_pt - 2}, options.title, {kTitle_pt});
    canvas.text({kEdge_pt, kEdge_pt + kTitle_pt + 11}, factsOf(picture),
                {kLegendText_pt, palette::kFaintInk});
  }
  drawLegend(canvas, layout.legend, {kEdge_pt, layout.legend_top}, layout.legend_width);
  drawScaleBar(canvas, layout.bar_m, layout.place.points_per_m,
               {size.x() - kEdge_pt - 6, layout.legend_top + 0.62 * kLegendRow_pt});
}

}  // namespace

cv::Mat figurePixels(const MapPicture& picture, const ObjectDatabase& database,
                     const FigureOptions& options) {
  const Layout layout = layoutOf(picture, database, options);
  Canvas canvas(CanvasFormat::kPixels, layout.size);
  drawFigure(canvas, picture, database, options, layout);
  return canvas.pixels();
}

FigureSize writeFigure(const CSemanticMap& map, const ObjectDatabase& database, const FigureOptions& options,
                 const std::filesystem::path& file) {
  std::string ending = file.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  if (ending == ".png") {
    std::vector<unsigned char> bytes;
    const cv::Mat pixels = figurePixels(map, database, options);
    cv::imencode(".png", pixels, bytes);
    writeFileAtomically(file, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
    return {pixels.cols, pixels.rows};
  }
  if (ending != ".pdf" && ending != ".svg")
    throw std::invalid_argument("no figure ends with '" + ending + "'");
  const Layout layout = layoutOf(map, database, options);
  Canvas canvas(ending == ".pdf" ? CanvasFormat::kPdf : CanvasFormat::kSvg, layout.size, options.title,
                map.world_from_robot.empty() ? 0 : map.world_from_robot.front().t);
  drawFigure(canvas, map, database, options, layout);
  writeFileAtomically(file, canvas.finishedFile());
  const Eigen::Vector2d pixels = layout.size / kPointsPerPixel;
  return {static_cast<int>(std::lround(pixels.x())), static_cast<int>(std::lround(pixels.y()))};
}

}  // namespace roomgraph
