// SPDX-License-Identifier: BSD-3-Clause
// Triangles of the outline font rasterised with oversampling and blended into the image; other letters by cairo.
#include "glyphs.h"

#include <cairo.h>
#include <mrpt/opengl/CText3D.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <opencv2/imgproc.hpp>

#include "canvas.h"

namespace roomgraph {
namespace {

constexpr int kOversampling = 8;

/// MRPT's text object, for the triangles that it would send to OpenGL.
class Outline : public mrpt::opengl::CText3D {
 public:
  explicit Outline(const std::string& text) : CText3D(text, "sans", 1.f, mrpt::opengl::FILL) {
    onUpdateBuffers_Text();
  }
  const std::vector<mrpt::opengl::TTriangle>& triangles() const { return m_triangles; }
};

double rightEnd(const Outline& outline) {
  double right = 0;
  for (const auto& triangle : outline.triangles())
    for (std::size_t i = 0; i < 3; ++i) right = std::max(right, static_cast<double>(triangle.x(i)));
  return right;
}

/// Height of a capital letter in the font's units.
double capHeight() {
  static const double height = [] {
    const Outline capital("H");
    double top = 0;
    for (const auto& triangle : capital.triangles())
      for (std::size_t i = 0; i < 3; ++i) top = std::max(top, static_cast<double>(triangle.y(i)));
    return top;
  }();
  return height;
}

/// Coverage in [0, 255] of the text's pixels; the base line starts at (margin, margin + ascent).
cv::Mat coverage(const Outline& outline, double scale, const cv::Size& size, const Eigen::Vector2d& base) {
  cv::Mat fine = cv::Mat::zeros(size * kOversampling, CV_8UC1);
  constexpr int kFractionBits = 4;
  const double unit = kOversampling * (1 << kFractionBits);
  for (const auto& triangle : outline.triangles()) {
    cv::Point corners[3];
    for (std::size_t i = 0; i < 3; ++i) {
      corners[i].x =
          static_cast<int>(std::lround((base.x() + static_cast<double>(triangle.x(i)) * scale) * unit));
      corners[i].y =
          static_cast<int>(std::lround((base.y() - static_cast<double>(triangle.y(i)) * scale) * unit));
    }
    cv::fillConvexPoly(fine, corners, 3, cv::Scalar(255), cv::LINE_8, kFractionBits);
  }
  cv::Mat mask;
  cv::resize(fine, mask, size, 0, 0, cv::INTER_AREA);
  return mask;
}

/// Letters that MRPT's font does not have need a font of the system's.
bool isOutlined(const std::string& text) {
  return std::all_of(text.begin(), text.end(), [](char c) { return c >= 0x20 && c < 0x7f; });
}

using Drawing = std::unique_ptr<cairo_t, decltype(&cairo_destroy)>;

Drawing lettersOnto(cv::Mat& pixels, double cap_height_px) {
  cairo_surface_t* surface = cairo_image_surface_create_for_data(
      pixels.data, CAIRO_FORMAT_A8, pixels.cols, pixels.rows, static_cast<int>(pixels.step));
  Drawing drawing(cairo_create(surface), cairo_destroy);
  cairo_surface_destroy(surface);  // the drawing keeps it
  cairo_select_font_face(drawing.get(), kFont, CAIRO_FONT_SLANT_NORMAL, CAIRO_FONT_WEIGHT_NORMAL);
  cairo_set_font_size(drawing.get(), cap_height_px / kCapShare);
  return drawing;
}

/// As coverage(), with the system's font.
cv::Mat coverageOfLetters(const std::string& text, double cap_height_px, const cv::Size& size, const Eigen::Vector2d& base) {
  const int stride = cairo_format_stride_for_width(CAIRO_FORMAT_A8, size.width);
  cv::Mat rows = cv::Mat::zeros(size.height, stride, CV_8UC1);
  cv::Mat mask = rows.colRange(0, size.width);
  const Drawing drawing = lettersOnto(mask, cap_height_px);
  cairo_move_to(drawing.get(), base.x(), base.y());
  cairo_show_text(drawing.get(), validText(text).c_str());
  cairo_surface_flush(cairo_get_target(drawing.get()));
  return mask.clone();
}

double widthOfLetters(const std::string& text, double cap_height_px) {
  cv::Mat none = cv::Mat::zeros(1, 4, CV_8UC1);
  const Drawing drawing = lettersOnto(none, cap_height_px);
  cairo_text_extents_t extents;
  cairo_text_extents(drawing.get(), validText(text).c_str(), &extents);
  return extents.x_advance;
}

void blend(cv::Mat& image, const cv::Mat& mask, const cv::Point& corner, const palette::TColor& color) {
  const int bgr[3] = {color.B, color.G, color.R};
  for (int v = std::max(0, -corner.y); v < mask.rows && v + corner.y < image.rows; ++v) {
    for (int u = std::max(0, -corner.x); u < mask.cols && u + corner.x < image.cols; ++u) {
      const int alpha = mask.at<unsigned char>(v, u);
      auto& pixel = image.at<cv::Vec3b>(v + corner.y, u + corner.x);
      for (int k = 0; k < 3; ++k)
        pixel[k] = static_cast<unsigned char>((alpha * bgr[k] + (255 - alpha) * pixel[k] + 127) / 255);
    }
  }
}

}  // namespace

double textWidth(const std::string& text, const TextStyle& style) {
  if (!isOutlined(text)) return widthOfLetters(text, style.cap_height_px);
  const Outline outline(text);
  return rightEnd(outline) * style.cap_height_px / capHeight();
}

void drawText(cv::Mat& image, const std::string& text, const Eigen::Vector2d& base, const TextStyle& style) {
  const int margin = 3 + static_cast<int>(std::ceil(2 * style.halo_px + style.cap_height_px));
  const cv::Point corner(static_cast<int>(std::floor(base.x())) - margin,
                         static_cast<int>(std::floor(base.y())) - 2 * margin);
  const cv::Size size(2 * margin + static_cast<int>(std::ceil(textWidth(text, style))), 3 * margin);
  const Eigen::Vector2d start = base - Eigen::Vector2d(corner.x, corner.y);
  const cv::Mat mask = isOutlined(text) ? coverage(Outline(text), style.cap_height_px / capHeight(), size, start)
                                        : coverageOfLetters(text, style.cap_height_px, size, start);
  if (style.halo_px > 0) {
    const int radius = static_cast<int>(std::lround(style.halo_px));
    cv::Mat halo;
    cv::dilate(mask, halo, cv::getStructuringElement(cv::MORPH_ELLIPSE, {2 * radius + 1, 2 * radius + 1}));
    cv::GaussianBlur(halo, halo, {2 * radius + 1, 2 * radius + 1}, style.halo_px / 2);
    blend(image, halo, corner, palette::kFree);
  }
  blend(image, mask, corner, style.color);
}

}  // namespace roomgraph
