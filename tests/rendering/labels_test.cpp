// SPDX-License-Identifier: BSD-3-Clause
// Label placement: no overlaps, inside the picture.
#include "labels.h"

#include <gtest/gtest.h>

namespace roomgraph {
namespace {

Label labelAt(double u, double v) {
  return {"x", {u - 20, v - 20, u + 20, v + 20}, 90, 12, {}};
}

TEST(Labels, ALoneLabelStandsBelowItsObject) {
  std::vector<Label> labels{labelAt(200, 200)};
  placeLabels(labels, {0, 0, 400, 400});
  EXPECT_NEAR(labels[0].place.center().x(), 200, 1e-9);
  EXPECT_GT(labels[0].place.v_min, 220);
  EXPECT_LT(labels[0].place.v_min, 232);
}

TEST(Labels, KeepOffEachOtherAndObjects) {
  std::vector<Label> labels;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) labels.push_back(labelAt(150 + 100 * i, 120 + 62 * j));
  placeLabels(labels, {0, 0, 500, 400});
  for (std::size_t i = 0; i < labels.size(); ++i) {
    for (std::size_t j = 0; j < labels.size(); ++j) {
      if (i < j) {
        EXPECT_EQ(intersection(labels[i].place, labels[j].place).area(), 0) << i << " " << j;
      }
      EXPECT_EQ(intersection(labels[i].place, labels[j].object).area(), 0) << i << " " << j;
    }
  }
}

// Two objects so near each other that the same place is free of objects for both labels.
TEST(Labels, OfNeighboursKeepOffEachOther) {
  std::vector<Label> labels{labelAt(200, 200), labelAt(215, 200)};
  placeLabels(labels, {0, 0, 400, 400});
  EXPECT_EQ(intersection(labels[0].place, labels[1].place).area(), 0);
}

TEST(Labels, StayInsideThePicture) {
  std::vector<Label> labels{labelAt(25, 375), labelAt(375, 25)};
  const Box2 area{0, 0, 400, 400};
  placeLabels(labels, area);
  for (const auto& label : labels)
    EXPECT_NEAR(intersection(label.place, area).area(), label.place.area(), 1e-9);
}

}  // namespace
}  // namespace roomgraph
