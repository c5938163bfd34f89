// SPDX-License-Identifier: BSD-3-Clause
// Tables of variants: spreads, pairs, what is significant.
#include "roomgraph/catalogue/comparison.h"

#include <gmock/gmock.h>

#include <map>
#include <string>

#include "errors_of.h"
#include "made_up_results.h"
#include "roomgraph/core/errors.h"
#include "temporary_folder.h"

namespace roomgraph::test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

class Compared : public ::testing::Test {
 protected:
  void add(const std::string& input, int seed, const std::string& variant, double ate) {
    RunResult r = madeUpResult(input, seed, variant);
    r.figures = {{"trajectory.ate_rmse_m", ate}};
    catalogue.import(r, "");
  }
  const TemporaryFolder folder;
  Catalogue catalogue = Catalogue::forWriting(folder.file("catalogue.sqlite"));
};

TEST_F(Compared, PairsAreOfOneInput) {
  for (int seed = 1; seed <= 8; ++seed) {
    add("lab", seed, "default", 0.1 * seed);
    if (seed != 5) add("lab", seed, "slow", 0.1 * seed + 0.01);
  }
  add("lab", 20, "slow", 5.0);  // without a partner
  const Comparison all = compareVariants(catalogue, {});
  EXPECT_THAT(all.variants, ElementsAre("default", "slow"));
  EXPECT_EQ(all.inputs, 9u);
  ASSERT_EQ(all.rows.size(), 1u);
  EXPECT_NEAR(all.rows[0].variants[0].spread.median, 0.45, 1e-12);
  EXPECT_FALSE(all.rows[0].variants[0].difference);
  const auto& slow = all.rows[0].variants[1];
  EXPECT_EQ(slow.spread.count, 8u);
  EXPECT_EQ(slow.difference->pairs, 7u);
  EXPECT_NEAR(slow.difference->median, 0.01, 1e-12);
  EXPECT_NEAR(slow.difference->test.p_value, 2.0 / 128, 1e-9);
  EXPECT_THAT(differenceTable(all).rows[0],
              ElementsAre("ATE, m", "slow", "7", "0.0100", "0.0100 .. 0.0100", "0.0156", "0.0156", "worse"));
  EXPECT_THAT(spreadTable(all).rows[0][2], ::testing::StartsWith("8: "));
}

// What a variant is joined from is compared when it is asked for, and then with its like.
TEST_F(Compared, PiecesAreNoVariants) {
  for (const char* variant : {"base.piece", "base", "slow.piece", "slow"}) add("lab", 1, variant, 1);
  EXPECT_THAT(compareVariants(catalogue, {}).variants, ElementsAre("base", "slow"));
  EXPECT_THAT(compareVariants(catalogue, {.baseline = "slow.piece"}).variants, ElementsAre("slow.piece", "base.piece"));
}

TEST_F(Compared, FailedRunsDoNotCount) {
  add("lab", 1, "default", 1);
  RunResult failed = madeUpResult("lab", 2, "default");
  failed.status = "failed";
  failed.figures = {{"trajectory.ate_rmse_m", 1000}};
  catalogue.import(failed, "");
  EXPECT_EQ(compareVariants(catalogue, {}).rows[0].variants[0].spread.largest, 1);
}

TEST_F(Compared, GroupAndBaselineAreChosen) {
  for (int seed = 1; seed <= 3; ++seed) {
    add("lab", seed, "b", 1);
    add("lab", seed, "a", 2);
    add("hall", seed, "b", 7);
  }
  EXPECT_THAT(compareVariants(catalogue, {}).variants, ElementsAre("b", "a")) << "that of the first run";
  EXPECT_THAT(compareVariants(catalogue, {.baseline = "a"}).variants, ElementsAre("a", "b"));
  const Comparison hall = compareVariants(catalogue, {.group = "hall"});
  EXPECT_EQ(hall.inputs, 3u);
  EXPECT_EQ(hall.rows[0].variants[0].spread.least, 7);
  EXPECT_THAT(messageOf<ConfigError>([&] { compareVariants(catalogue, {.group = "halle"}); }),
              HasSubstr("did you mean 'hall'"));
  EXPECT_THAT(messageOf<ConfigError>([&] { compareVariants(catalogue, {.baseline = "c"}); }),
              HasSubstr("a, b"));
  EXPECT_THAT(messageOf<ConfigError>([&] { compareVariants(catalogue, {.figures = {"ate"}}); }),
              HasSubstr("trajectory.ate_rmse_m"));
}

TEST_F(Compared, ManyTestsAskForMore) {
  for (int seed = 1; seed <= 6; ++seed) {
    add("lab", seed, "default", 0);
    for (const char* variant : {"v1", "v2", "v3"}) add("lab", seed, variant, seed);
  }
  const Comparison all = compareVariants(catalogue, {.figures = {"trajectory.ate_rmse_m"}});
  int compared = 0;
  for (const auto& variant : all.rows.at(0).variants)
    if (variant.difference) {
      ++compared;
      EXPECT_NEAR(variant.difference->test.p_value, 2.0 / 64, 1e-12);
      EXPECT_FALSE(variant.difference->significant()) << "3 tests: 0.094";
    }
  EXPECT_EQ(compared, 3);
}

TEST_F(Compared, WhatIsBetterDependsOnTheFigure) {
  for (int seed = 1; seed <= 12; ++seed)
    for (const char* variant : {"default", "other"}) {
      RunResult r = madeUpResult("lab", seed, variant);
      const double change = variant == std::string("other") ? 0.1 : 0;
      r.figures = {{"trajectory.ate_rmse_m", 1 + seed - change},
                   {"objects.f1", 0.01 * seed - change},
                   {"counts.landmarks", 10 + change},
                   {"map.f1", 0.5}};
      r.revision = seed % 2 ? "even" : "odd";
      catalogue.import(r, "");
    }
  const Comparison all = compareVariants(catalogue, {});
  EXPECT_THAT(all.revisions, ElementsAre("even", "odd"));
  EXPECT_THAT(all.groups, ElementsAre("lab"));
  std::map<std::string, std::string> meaning;
  for (const auto& row : differenceTable(all).rows) meaning[row.front()] = row.back();
  EXPECT_EQ(meaning.at("ATE, m"), "better");
  EXPECT_EQ(meaning.at("objects: F1"), "worse");
  EXPECT_EQ(meaning.at("objects in the map"), "differs");
  EXPECT_EQ(meaning.at("map: F1 of occupied"), "") << "no difference";
  EXPECT_THAT(spreadTable(all).rows[0][2], ::testing::EndsWith(" *"));
}

TEST_F(Compared, AFigureThatAVariantLacksIsADash) {
  add("lab", 1, "default", 1);
  RunResult without = madeUpResult("lab", 1, "blind");
  without.figures = {{"objects.f1", -0.0001}};
  catalogue.import(without, "");
  const TextTable table = spreadTable(compareVariants(catalogue, {}));
  ASSERT_EQ(table.rows.size(), 2u);
  EXPECT_THAT(table.columns, ElementsAre("figure", "default", "blind"));
  EXPECT_THAT(table.rows[0], ElementsAre("ATE, m", "1.000", "-"));
  EXPECT_THAT(table.rows[1], ElementsAre("objects: F1", "-", "0.000"));
  EXPECT_TRUE(differenceTable(compareVariants(catalogue, {})).rows.empty()) << "no pair";
}

TEST_F(Compared, FewPairsHaveNoInterval) {
  for (int seed = 1; seed <= 6; ++seed) {
    for (const char* variant : {"base", "slow"}) add("lab", seed, variant, seed + (variant[0] == 's'));
    const auto row = differenceTable(compareVariants(catalogue, {})).rows.at(0);
    EXPECT_EQ(row[4], seed < 6 ? "-" : "1.0000 .. 1.0000") << seed;
  }
}

TEST_F(Compared, AnEmptyCatalogueHasNoRows) {
  EXPECT_TRUE(compareVariants(catalogue, {}).rows.empty());
  EXPECT_TRUE(differenceTable(compareVariants(catalogue, {})).rows.empty());
}

}  // namespace
}  // namespace roomgraph::test
