// SPDX-License-Identifier: BSD-3-Clause
// Surfaces of cairo behind the canvas; text made valid before cairo sees it.
#include "canvas.h"

#include <cairo-pdf.h>
#include <cairo-svg.h>

#include <cmath>
#include <ctime>
#include <opencv2/imgproc.hpp>

#include "roomgraph/core/errors.h"

namespace roomgraph {
namespace {


cairo_status_t append(void* bytes, const unsigned char* data, unsigned length) {
  static_cast<std::string*>(bytes)->append(reinterpret_cast<const char*>(data), length);
  return CAIRO_STATUS_SUCCESS;
}

cairo_surface_t* makeSurface(CanvasFormat format, const Eigen::Vector2d& size, std::string* bytes) {
  if (format == CanvasFormat::kPdf)
    return cairo_pdf_surface_create_for_stream(append, bytes, size.x(), size.y());
  if (format == CanvasFormat::kSvg)
    return cairo_svg_surface_create_for_stream(append, bytes, size.x(), size.y());
  const auto pixels = [](double points) { return static_cast<int>(std::lround(points / kPointsPerPixel)); };
  return cairo_image_surface_create(CAIRO_FORMAT_RGB24, pixels(size.x()), pixels(size.y()));
}

/// Bytes of the character that begins at `at` when it is well-formed UTF-8 and printable; 0 otherwise.
std::size_t characterAt(const std::string& text, std::size_t at) {
  const auto byte = [&](std::size_t i) { return i < text.size() ? static_cast<unsigned char>(text[i]) : 0u; };
  const unsigned first = byte(at);
  if (first < 0x80) return first >= 0x20 && first != 0x7f ? 1 : 0;
  const std::size_t length = first >= 0xf0 ? 4 : first >= 0xe0 ? 3 : 2;
  unsigned code = first & (0xffu >> (length + 1));
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(at + i) & 0xc0u) != 0x80u) return 0;
    code = code << 6 | (byte(at + i) & 0x3fu);
  }
  const unsigned least = length == 2 ? 0x80 : length == 3 ? 0x800 : 0x10000;
  const bool good = first < 0xf5 && code >= least && code <= 0x10ffff && !(code >= 0xd800 && code <= 0xdfff);
  return good ? length : 0;
}

/// cairo numbers the surfaces of a process: the only thing in a file that tells the second from the first.
std::string withoutCounter(const std::string& svg) {
  const std::string name = "id=\"surface";
  const auto at = svg.find(name);
  if (at == std::string::npos) return svg;
  const auto end = svg.find('"', at + name.size());
  return svg.substr(0, at + name.size()) + svg.substr(end);
}

std::string isoTime(double t) {
  const auto seconds = static_cast<std::time_t>(std::clamp(t, 0.0, 4e9));
  std::tm parts{};
  gmtime_r(&seconds, &parts);
  char text[32];
  std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &parts);
  return text;
}

}  // namespace

std::string validText(const std::string& text) {
  std::string out;
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t length = characterAt(text, i);
    out += length ? text.substr(i, length) : "?";
    i += std::max<std::size_t>(length, 1);
  }
  return out;
}

Canvas::Canvas(CanvasFormat format, const Eigen::Vector2d& size, const std::string& title, double t)
    : format_(format),
      size_(size),
      bytes_(std::make_unique<std::string>()),
      surface_(makeSurface(format, size, bytes_.get()), cairo_surface_destroy),
      cairo_(cairo_create(surface_.get()), cairo_destroy) {
  if (format == CanvasFormat::kPdf) {
    cairo_pdf_surface_set_metadata(surface_.get(), CAIRO_PDF_METADATA_TITLE, validText(title).c_str());
    cairo_pdf_surface_set_metadata(surface_.get(), CAIRO_PDF_METADATA_CREATOR, "roomgraph");
    cairo_pdf_surface_set_metadata(surface_.get(), CAIRO_PDF_METADATA_CREATE_DATE, isoTime(t).c_str());
  }
  if (format == CanvasFormat::kPixels) cairo_scale(cairo_.get(), 1 / kPointsPerPixel, 1 / kPointsPerPixel);
  cairo_select_font_face(cairo_.get(), kFont, CAIRO_FONT_SLANT_NORMAL, CAIRO_FONT_WEIGHT_NORMAL);
  cairo_set_line_join(cairo_.get(), CAIRO_LINE_JOIN_ROUND);
}

void Canvas::choose(const palette::TColor& color) {
  cairo_set_source_rgba(cairo_.get(), color.R / 255.0, color.G / 255.0, color.B / 255.0, color.A / 255.0);
}

void Canvas::path(const Polygon2& points, bool closed) {
  for (std::size_t i = 0; i < points.size(); ++i)
    (i ? cairo_line_to : cairo_move_to)(cairo_.get(), points[i].x(), points[i].y());
  if (closed) cairo_close_path(cairo_.get());
}

void Canvas::area(const std::vector<Polygon2>& rings, const palette::TColor& color) {
  for (const auto& ring : rings) path(ring, true);
  choose(color);
  cairo_set_fill_rule(cairo_.get(), CAIRO_FILL_RULE_EVEN_ODD);
  cairo_fill(cairo_.get());
}

void Canvas::line(const Polygon2& points, const Pen& pen, bool closed) {
  if (points.empty()) return;
  path(points, closed);
  choose(pen.color);
  cairo_set_line_width(cairo_.get(), pen.width);
  cairo_set_line_cap(cairo_.get(), pen.dashes.empty() ? CAIRO_LINE_CAP_ROUND : CAIRO_LINE_CAP_BUTT);
  cairo_set_dash(cairo_.get(), pen.dashes.data(), static_cast<int>(pen.dashes.size()), 0);
  cairo_stroke(cairo_.get());
}

void Canvas::clip(const Polygon2& corners) {
  cairo_save(cairo_.get());
  path(corners, true);
  cairo_clip(cairo_.get());
}

void Canvas::release() {
  cairo_restore(cairo_.get());
}

double Canvas::textWidth(const std::string& words, const Lettering& lettering) {
  cairo_set_font_size(cairo_.get(), lettering.size);
  cairo_text_extents_t extents;
  cairo_text_extents(cairo_.get(), validText(words).c_str(), &extents);
  return extents.x_advance;
}

void Canvas::text(const Eigen::Vector2d& at, const std::string& words, const Lettering& lettering) {
  const double width = textWidth(words, lettering);
  const double share = lettering.align == TextAlign::kLeft     ? 0
                       : lettering.align == TextAlign::kCenter ? 0.5
                                                               : 1;
  const std::string text = validText(words);
  const Eigen::Vector2d start = at - Eigen::Vector2d(share * width, 0);
  if (lettering.halo > 0) {
    cairo_move_to(cairo_.get(), start.x(), start.y());
    cairo_text_path(cairo_.get(), text.c_str());
    choose(palette::withAlpha(palette::kFree, 225));
    cairo_set_dash(cairo_.get(), nullptr, 0, 0);
    cairo_set_line_width(cairo_.get(), 2 * lettering.halo);
    cairo_stroke(cairo_.get());
  }
  cairo_move_to(cairo_.get(), start.x(), start.y());
  choose(lettering.color);
  cairo_show_text(cairo_.get(), text.c_str());
}

std::string Canvas::finishedFile() {
  cairo_show_page(cairo_.get());
  cairo_surface_finish(surface_.get());
  const cairo_status_t drawn = cairo_status(cairo_.get()), written = cairo_surface_status(surface_.get());
  if (const auto status = drawn != CAIRO_STATUS_SUCCESS ? drawn : written; status != CAIRO_STATUS_SUCCESS)
    throw RunError(std::string("drawing failed: ") + cairo_status_to_string(status));
  return format_ == CanvasFormat::kSvg ? withoutCounter(*bytes_) : *bytes_;
}

cv::Mat Canvas::pixels() {
  cairo_surface_flush(surface_.get());
  if (const auto status = cairo_status(cairo_.get()); status != CAIRO_STATUS_SUCCESS)
    throw RunError(std::string("drawing failed: ") + cairo_status_to_string(status));
  const cv::Mat shared(cairo_image_surface_get_height(surface_.get()),
                       cairo_image_surface_get_width(surface_.get()), CV_8UC4,
                       cairo_image_surface_get_data(surface_.get()),
                       static_cast<std::size_t>(cairo_image_surface_get_stride(surface_.get())));
  cv::Mat out;
  cv::cvtColor(shared, out, cv::COLOR_BGRA2BGR);
  return out;
}

Polygon2 circleAt(const Eigen::Vector2d& centre, double radius, int corners) {
  Polygon2 out;
  for (int i = 0; i < corners; ++i) {
    const double angle = 2 * M_PI * i / corners;
    out.push_back(centre + radius * Eigen::Vector2d(std::cos(angle), std::sin(angle)));
  }
  return out;
}

}  // namespace roomgraph
