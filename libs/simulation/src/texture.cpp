// SPDX-License-Identifier: BSD-3-Clause
// Painters of the texture patterns: noise, wood, tiles, posters, screens.
#include "texture.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <opencv2/imgproc.hpp>

#include "roomgraph/core/errors.h"
#include "roomgraph/core/random.h"
#include "roomgraph/core/suggest.h"

namespace roomgraph {
namespace {

constexpr int kTexels = 256;

cv::Scalar bgr(const std::array<double, 3>& rgb, double gain = 1) {
  return {255 * rgb[2] * gain, 255 * rgb[1] * gain, 255 * rgb[0] * gain};
}

/// Smooth noise of unit amplitude that tiles: `cells` random values per edge, interpolated.
cv::Mat noise(Random& random, int cells_u, int cells_v) {
  cv::Mat coarse(cells_v, cells_u, CV_32F);
  for (int v = 0; v < cells_v; ++v)
    for (int u = 0; u < cells_u; ++u) coarse.at<float>(v, u) = static_cast<float>(random.uniform(-1, 1));
  cv::Mat tiled, fine;
  cv::repeat(coarse, 3, 3, tiled);
  cv::resize(tiled, fine, {3 * kTexels, 3 * kTexels}, 0, 0, cv::INTER_CUBIC);
  return fine(cv::Rect(kTexels, kTexels, kTexels, kTexels)).clone();
}

/// Main colour, its brightness changed by 1 + gain.
cv::Mat shaded(const Material& material, const cv::Mat& gain) {
  cv::Mat out(kTexels, kTexels, CV_8UC3);
  const cv::Scalar base = bgr(material.rgb);
  for (int v = 0; v < kTexels; ++v)
    for (int u = 0; u < kTexels; ++u)
      for (int k = 0; k < 3; ++k)
        out.at<cv::Vec3b>(v, u)[k] = cv::saturate_cast<uchar>(base[k] * (1 + gain.at<float>(v, u)));
  return out;
}

cv::Mat plain(const Material& m, Random&) {
  return shaded(m, cv::Mat::zeros(kTexels, kTexels, CV_32F));
}

cv::Mat paint(const Material& m, Random& random) {
  return shaded(m, 0.015 * noise(random, 4, 4) + 0.012 * noise(random, 24, 24));
}

cv::Mat plaster(const Material& m, Random& random) {
  return shaded(m, 0.05 * noise(random, 5, 5) + 0.06 * noise(random, 20, 20) + 0.07 * noise(random, 64, 64));
}

cv::Mat carpet(const Material& m, Random& random) {
  return shaded(m,
                0.10 * noise(random, 12, 12) + 0.12 * noise(random, 60, 60) + 0.16 * noise(random, 128, 128));
}

cv::Mat fabric(const Material& m, Random& random) {
  cv::Mat weave(kTexels, kTexels, CV_32F);
  for (int v = 0; v < kTexels; ++v)
    for (int u = 0; u < kTexels; ++u) weave.at<float>(v, u) = ((u / 2 + v / 2) % 2 == 0) ? 0.03f : -0.03f;
  return shaded(m, weave + 0.05 * noise(random, 8, 8) + 0.08 * noise(random, 64, 64));
}

cv::Mat leather(const Material& m, Random& random) {
  return shaded(m, 0.05 * noise(random, 6, 6) + 0.05 * noise(random, 40, 40));
}

cv::Mat wood(const Material& m, Random& random) {
  return shaded(m, 0.09 * noise(random, 2, 12) + 0.10 * noise(random, 3, 48) + 0.05 * noise(random, 8, 120));
}

cv::Mat metal(const Material& m, Random& random) {
  return shaded(m, 0.05 * noise(random, 3, 90));
}

cv::Mat leaf(const Material& m, Random& random) {
  return shaded(m, 0.22 * noise(random, 10, 10) + 0.16 * noise(random, 40, 40));
}

cv::Mat tiles(const Material& m, Random& random) {
  cv::Mat out = shaded(m, 0.04 * noise(random, 6, 6) + 0.05 * noise(random, 50, 50));
  for (int i = 0; i < 2; ++i) {
    const int at = i * kTexels / 2;
    cv::rectangle(out, {at, 0, 2, kTexels}, bgr(m.rgb, 0.6), cv::FILLED);
    cv::rectangle(out, {0, at, kTexels, 2}, bgr(m.rgb, 0.6), cv::FILLED);
  }
  return out;
}

cv::Mat parquet(const Material& m, Random& random) {
  cv::Mat out = wood(m, random);
  const int rows = 16;
  for (int row = 0; row < rows; ++row) {
    const int top = row * kTexels / rows, offset = static_cast<int>(random.uniform() * kTexels);
    for (int half = 0; half < 2; ++half) {
      const double gain = random.uniform(0.82, 1.12);
      for (int i = 0; i < kTexels / 2; ++i) {
        const int u = (offset + half * kTexels / 2 + i) % kTexels;
        for (int v = top; v < top + kTexels / rows; ++v)
          for (int k = 0; k < 3; ++k)
            out.at<cv::Vec3b>(v, u)[k] =
                cv::saturate_cast<uchar>(out.at<cv::Vec3b>(v, u)[k] * (i == 0 || v == top ? 0.6 : gain));
      }
    }
  }
  return out;
}

cv::Scalar vivid(Random& random) {
  return {random.uniform(20, 235), random.uniform(20, 235), random.uniform(20, 235)};
}

/// A picture on a wall: blocks, discs and lines of text.
cv::Mat poster(const Material& m, Random& random) {
  cv::Mat out(kTexels, kTexels, CV_8UC3, bgr(m.rgb));
  const auto any = [&](double low, double high) {
    return static_cast<int>(random.uniform(low, high) * kTexels);
  };
  for (int i = 0; i < 7; ++i)
    cv::rectangle(out, cv::Rect(any(0.02, 0.75), any(0.02, 0.6), any(0.1, 0.4), any(0.08, 0.3)),
                  vivid(random), cv::FILLED);
  for (int i = 0; i < 5; ++i)
    cv::circle(out, {any(0.1, 0.9), any(0.1, 0.6)}, any(0.03, 0.14), vivid(random), cv::FILLED, cv::LINE_AA);
  cv::rectangle(out, {0, 7 * kTexels / 10, kTexels, kTexels / 3}, bgr(m.rgb), cv::FILLED);
  for (int line = 0; line < 5; ++line) {
    const int top = kTexels * 73 / 100 + line * kTexels / 20;
    for (int at = kTexels / 16; at < kTexels * 7 / 8;) {
      const int length = any(0.02, 0.1);
      cv::rectangle(out, {at, top, length, kTexels / 40}, {40, 40, 40}, cv::FILLED);
      at += length + kTexels / 60;
    }
  }
  cv::rectangle(out, {0, 0, kTexels, kTexels}, bgr(m.rgb, 0.35), 5);
  return out(cv::Rect(0, 0, kTexels, kTexels)).clone();
}

/// A computer's desktop: windows with lines of text.
cv::Mat screen(const Material& m, Random& random) {
  cv::Mat out(kTexels, kTexels, CV_8UC3, bgr(m.rgb));
  for (int window = 0; window < 3; ++window) {
    const int left = static_cast<int>(random.uniform(0.03, 0.45) * kTexels);
    const int top = static_cast<int>(random.uniform(0.05, 0.4) * kTexels);
    const cv::Rect area(left, top, kTexels / 2, kTexels / 2);
    const bool dark = random.chance(0.4);
    cv::rectangle(out, area, dark ? cv::Scalar(45, 40, 38) : cv::Scalar(245, 243, 240), cv::FILLED);
    cv::rectangle(out, {left, top, area.width, 12}, {150, 110, 60}, cv::FILLED);
    for (int v = top + 20; v < top + area.height - 8; v += 10)
      cv::rectangle(out, {left + 8, v, static_cast<int>(random.uniform(0.1, 0.42) * kTexels), 4},
                    dark ? cv::Scalar(170, 200, 150) : cv::Scalar(90, 80, 80), cv::FILLED);
  }
  cv::rectangle(out, {0, kTexels - 12, kTexels, 12}, {60, 50, 45}, cv::FILLED);
  return out;
}

cv::Mat cardboard(const Material& m, Random& random) {
  cv::Mat out = shaded(m, 0.03 * noise(random, 4, 4) + 0.05 * noise(random, 64, 8));
  cv::rectangle(out, {kTexels * 45 / 100, 0, kTexels / 10, kTexels}, bgr(m.rgb, 1.2), cv::FILLED);
  cv::rectangle(out, {kTexels / 10, kTexels / 8, kTexels / 4, kTexels / 6}, {235, 235, 235}, cv::FILLED);
  return out;
}

/// 9 by 6 inner corners within a white edge as wide as a square: a picture of 12 by 9 squares.
cv::Mat chessboard(const Material& m) {
  constexpr int kColumns = 12, kRows = 9, kSquare = 16;
  cv::Mat out(kRows * kSquare, kColumns * kSquare, CV_8UC3, bgr(m.rgb));
  for (int row = 1; row + 1 < kRows; ++row)
    for (int column = 1; column + 1 < kColumns; ++column)
      if ((row + column) % 2 == 0)
        cv::rectangle(out, {column * kSquare, row * kSquare, kSquare, kSquare}, {25, 25, 25}, cv::FILLED);
  return out;
}

using Painter = std::function<cv::Mat(const Material&, Random&)>;

const std::map<std::string, Painter>& painters() {
  static const std::map<std::string, Painter> all{
      {"plain", plain},   {"paint", paint},        {"plaster", plaster}, {"carpet", carpet},
      {"fabric", fabric}, {"wood", wood},          {"leather", leather}, {"metal", metal},
      {"leaf", leaf},     {"tiles", tiles},        {"parquet", parquet}, {"poster", poster},
      {"screen", screen}, {"cardboard", cardboard}};
  return all;
}

}  // namespace

const std::vector<std::string>& texturePatterns() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> out;
    for (const auto& [name, painter] : painters()) out.push_back(name);
    return out;
  }();
  return names;
}

cv::Mat textureOf(const Material& material) {
  if (material.picture) return *material.picture;
  if (material.pattern == kChessboardPattern) return chessboard(material);
  const auto painter = painters().find(material.pattern);
  if (painter == painters().end())
    throw ConfigError("unknown surface pattern '" + material.pattern + "': one of " +
                      join(texturePatterns()));
  Random random(0x7e57u, static_cast<std::uint64_t>(std::distance(painters().begin(), painter)),
                static_cast<std::uint64_t>(material.variant));
  return painter->second(material, random);
}

}  // namespace roomgraph
