// SPDX-License-Identifier: BSD-3-Clause
// Aligned tables and CSV.
#include "roomgraph/catalogue/text_table.h"

#include <gmock/gmock.h>

#include "made_up_results.h"
#include "temporary_folder.h"

namespace roomgraph::test {
namespace {

TEST(TextTables, AreAligned) {
  EXPECT_EQ(alignedText({{"name", "n"}, {{"Größe", "7"}, {"a", "12"}}, {false, true}}),
            "name    n\n-----  --\nGröße   7\na      12\n");
}

TEST(TextTables, CsvQuotesWhatItMust) {
  EXPECT_EQ(csvText({{"a", "b"}, {{"x,y", "say \"no\""}, {"two\nlines", "plain"}}}),
            "a,b\n\"x,y\",\"say \"\"no\"\"\"\n\"two\nlines\",plain\n");
}

TEST(TextTables, AWideTableHasARowForEachRun) {
  const TemporaryFolder folder;
  Catalogue catalogue = Catalogue::forWriting(folder.file("c"));
  RunResult second = madeUpResult("lab", 2, "default");
  second.figures = {{"a.new_one", 1.0 / 3}};
  catalogue.import(madeUpResult("lab", 1, "default"), "");
  catalogue.import(second, "");
  const TextTable table = wideTable(catalogue);
  const auto at = [&](std::size_t row, const std::string& column) {
    const auto place = std::find(table.columns.begin(), table.columns.end(), column) - table.columns.begin();
    return table.rows.at(row).at(static_cast<std::size_t>(place));
  };
  EXPECT_EQ(at(0, "run"), "lab_s1--default");
  EXPECT_EQ(at(0, "objects.f1"), "0.5");
  EXPECT_EQ(at(0, "a.new_one"), "");
  EXPECT_EQ(at(1, "seed"), "2");
  EXPECT_EQ(std::stod(at(1, "a.new_one")), 1.0 / 3) << "exactly";
}

}  // namespace
}  // namespace roomgraph::test
