// SPDX-License-Identifier: BSD-3-Clause
// Colours as people with a dichromacy see them: far enough apart.
#include "roomgraph/rendering/palette.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>
#include <map>

namespace roomgraph {
namespace {

using palette::TColor;

// Colours next to each other on a map differ by 2.3 where just noticeable (Mahy et al. 1994); this is six
// times as far.
constexpr double kApart = 15;

/// Severity 1 of G. M. Machado, M. M. Oliveira, L. A. F. Fernandes, "A physiologically-based model for
/// simulation of color vision deficiency", IEEE TVCG 15(6), 2009; of linear RGB.
std::map<std::string, Eigen::Matrix3d> deficiencies() {
  Eigen::Matrix3d protan, deutan, tritan;
  protan << 0.152286, 1.052583, -0.204868, 0.114503, 0.786281, 0.099216, -0.003882, -0.048116, 1.051998;
  deutan << 0.367322, 0.860646, -0.227968, 0.280085, 0.672501, 0.047413, -0.011820, 0.042940, 0.968881;
  tritan << 1.255528, -0.076749, -0.178779, -0.078411, 0.930809, 0.147602, 0.004733, 0.691367, 0.303900;
  return {{"none", Eigen::Matrix3d::Identity()}, {"protan", protan}, {"deutan", deutan}, {"tritan", tritan}};
}

double linear(double channel) {
  const double c = channel / 255;
  return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
}

/// CIE L*a*b* of a colour as it is seen; sRGB primaries, D65.
Eigen::Vector3d seen(const TColor& color, const Eigen::Matrix3d& deficiency) {
  const Eigen::Vector3d rgb =
      (deficiency * Eigen::Vector3d(linear(color.R), linear(color.G), linear(color.B)))
          .cwiseMax(0)
          .cwiseMin(1);
  Eigen::Matrix3d xyz_from_rgb;
  xyz_from_rgb << 0.4124564, 0.3575761, 0.1804375, 0.2126729, 0.7151522, 0.0721750, 0.0193339, 0.1191920,
      0.9503041;
  Eigen::Vector3d f = (xyz_from_rgb * rgb).cwiseQuotient(Eigen::Vector3d(0.95047, 1, 1.08883));
  for (double& x : f) x = x > 216.0 / 24389 ? std::cbrt(x) : (24389.0 / 27 * x + 16) / 116;
  return {116 * f.y() - 16, 500 * (f.x() - f.y()), 200 * (f.y() - f.z())};
}

double leastDistance(const std::vector<TColor>& colors, const Eigen::Matrix3d& deficiency) {
  double least = 1e9;
  for (std::size_t i = 0; i < colors.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      least = std::min(least, (seen(colors[i], deficiency) - seen(colors[j], deficiency)).norm());
  return least;
}

/// What the colours of classes are not to be taken for.
std::vector<TColor> withMap(std::vector<TColor> colors) {
  colors.insert(colors.end(), {palette::kPathEnd, palette::kOccupied, palette::kFree});
  return colors;
}

TEST(Palette, TheSafeColoursAreFarApartForEveryEye) {
  for (const auto& [name, deficiency] : deficiencies())
    EXPECT_GT(leastDistance(withMap(palette::colorBlindSafe()), deficiency), kApart) << name;
}

TEST(Palette, TheShippedClassesAreToo) {
  const auto objects = ObjectDatabase::fromFile(std::string(ROOMGRAPH_SOURCE_DIR) + "/objects.ini");
  std::vector<TColor> colors;
  for (const auto& model : objects.models()) colors.push_back(palette::parse(model.color));
  ASSERT_EQ(colors.size(), 4u);
  for (const auto& [name, deficiency] : deficiencies())
    EXPECT_GT(leastDistance(withMap(colors), deficiency), kApart) << name;
}

TEST(Palette, RedAndGreenOfOneBrightnessWouldFail) {
  const std::vector<TColor> traffic_light{{190, 60, 50}, {90, 120, 40}};
  EXPECT_GT(leastDistance(traffic_light, deficiencies().at("none")), 60);
  EXPECT_LT(leastDistance(traffic_light, deficiencies().at("deutan")), kApart);
}

TEST(Palette, SafeColoursGoToTheClassesInOrderAndNoTwoAreAlike) {
  const auto home = ObjectDatabase::fromFile(std::string(ROOMGRAPH_SOURCE_DIR) + "/objects_home.ini");
  const auto safe = palette::withSafeColors(home);
  ASSERT_EQ(safe.models().size(), home.models().size());
  std::map<std::string, std::string> by_color;
  for (std::size_t i = 0; i < home.models().size(); ++i) {
    const auto& model = safe.models()[i];
    EXPECT_EQ(model.class_name, home.models()[i].class_name);
    EXPECT_EQ(model.shape, home.models()[i].shape) << "hatching goes by the shape";
    EXPECT_EQ(model.landmark, home.models()[i].landmark);
    EXPECT_TRUE(by_color.emplace(model.color, model.class_name).second) << model.class_name;
  }
  EXPECT_EQ(palette::ofClass(safe, "swivel_chair").R, palette::colorBlindSafe()[0].R);
  EXPECT_EQ(palette::ofClass(safe, "sofa").B, palette::colorBlindSafe()[1].B);
}

}  // namespace
}  // namespace roomgraph
