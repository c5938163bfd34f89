// SPDX-License-Identifier: BSD-3-Clause
// Canvas: lines, areas and text on a page that becomes PDF, SVG or pixels.
#pragma once

#include <cairo.h>

#include <Eigen/Core>
#include <memory>
#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

#include "roomgraph/maptools/grid_outlines.h"
#include "roomgraph/rendering/palette.h"

namespace roomgraph {

enum class CanvasFormat { kPdf, kSvg, kPixels };

/// Points of a typographer, 1/72 inch, and pixels of 1/96 inch as CSS has them.
constexpr double kPointsPerMillimeter = 72 / 25.4, kPointsPerPixel = 72.0 / 96;

constexpr const char* kFont = "DejaVu Sans";
constexpr double kCapShare = 0.729;  ///< height of its capital letters in its size

/// File names may hold any bytes; cairo gives up for good at the first that is no text.
std::string validText(const std::string& text);

struct Pen {
  palette::TColor color = palette::kInk;
  double width = 0.75;         ///< pt
  std::vector<double> dashes;  ///< on, off, … in pt; empty: solid
};

enum class TextAlign { kLeft, kCenter, kRight };

struct Lettering {
  double size = 8;  ///< of the font, pt; capital letters have .73 of it
  palette::TColor color = palette::kInk;
  TextAlign align = TextAlign::kLeft;
  double halo = 0;  ///< white rim, pt
};

/// A page that is drawn once. Page coordinates: pt from the upper left corner, x right, y down. Files are the
/// same for the same drawing: no clock, no random names. Text is DejaVu Sans, which every font configuration
/// of Debian has.
class Canvas {
 public:
  /// Of this size in pt. `title` and `t` (s since 1970) go into a PDF as its title and date.
  Canvas(CanvasFormat format, const Eigen::Vector2d& size, const std::string& title = "", double t = 0);

  const Eigen::Vector2d& size() const { return size_; }
  /// Closed polygons, holes as holes. The colour's alpha counts.
  void area(const std::vector<Polygon2>& rings, const palette::TColor& color);
  void line(const Polygon2& points, const Pen& pen, bool closed = false);
  /// Until release(): draws only inside the polygon.
  void clip(const Polygon2& corners);
  void release();
  /// At the base line.
  void text(const Eigen::Vector2d& at, const std::string& words, const Lettering& lettering);
  double textWidth(const std::string& words, const Lettering& lettering);

  /// Ends the drawing: the bytes of the PDF or SVG. Throws RunError when the library failed (no memory).
  std::string finishedFile();
  /// The pixels so far, BGR; kPixels only.
  cv::Mat pixels();

 private:
  void path(const Polygon2& points, bool closed);
  void choose(const palette::TColor& color);

  CanvasFormat format_;
  Eigen::Vector2d size_;
  std::unique_ptr<std::string> bytes_;
  std::unique_ptr<cairo_surface_t, decltype(&cairo_surface_destroy)> surface_;
  std::unique_ptr<cairo_t, decltype(&cairo_destroy)> cairo_;
};

/// A circle as polygon.
Polygon2 circleAt(const Eigen::Vector2d& centre, double radius, int corners = 48);

}  // namespace roomgraph
