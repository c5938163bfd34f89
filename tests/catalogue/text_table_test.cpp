// SPDX-License-Identifier: BSD-3-Clause
// Aligned tables and CSV.
#include "roomgraph/catalogue/text_table.h"

#include <gmock/gmock.h>

#include <random>

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

// Reads what RFC 4180 says, by itself.
std::vector<std::vector<std::string>> cellsOfCsv(const std::string& text) {
  std::vector<std::vector<std::string>> rows(1, {""});
  bool quoted = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '"') {
      if (quoted && i + 1 < text.size() && text[i + 1] == '"')
        rows.back().back() += text[++i];
      else
        quoted = !quoted;
    } else if (text[i] == ',' && !quoted) {
      rows.back().emplace_back();
    } else if (text[i] == '\n' && !quoted) {
      rows.push_back({""});
    } else {
      rows.back().back() += text[i];
    }
  }
  rows.pop_back();  // begun by the last line's end
  return rows;
}

TEST(TextTables, AnyTableIsReadBackFromItsCsv) {
  std::mt19937 random(3);
  const auto below = [&](int n) { return std::uniform_int_distribution<int>(0, n - 1)(random); };
  for (int i = 0; i < 200; ++i) {
    const int columns = 1 + below(4);
    std::vector<std::vector<std::string>> rows;
    for (int r = 1 + below(5); r > 0; --r) {
      rows.emplace_back();
      for (int c = 0; c < columns; ++c) {
        std::string cell;
        for (int k = below(6); k > 0; --k) cell += "a,\"\n \r;'"[below(8)];
        rows.back().push_back(cell);
      }
    }
    const TextTable table{rows.front(), {rows.begin() + 1, rows.end()}, {}};
    EXPECT_EQ(cellsOfCsv(csvText(table)), rows) << csvText(table);
  }
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
