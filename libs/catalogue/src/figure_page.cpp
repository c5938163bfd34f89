// SPDX-License-Identifier: BSD-3-Clause
// HTML of the page: tables, small box plots, list of runs.
#include "roomgraph/catalogue/figure_page.h"

#include <algorithm>
#include <cstdio>
#include <map>
#include <set>

#include "roomgraph/core/markup.h"

namespace roomgraph {
namespace {

constexpr std::size_t kListedRuns = 2000;

constexpr const char* kStyle = R"(
:root { color-scheme: light dark; --paper: #f6f5f1; --card: #fff; --ink: #1a1f24; --muted: #59636d; --line: #e1ded6; --accent: #0b6784;
  --warn: #8a4b00; --box: #a9cdd8; }
@media (prefers-color-scheme: dark) { :root { --paper: #111518; --card: #191e23; --ink: #e7eaec; --muted: #9ca7b0; --line: #2c343b;
  --accent: #68c6e0; --warn: #f0b66a; --box: #2d5a68; } }
body { margin: auto; max-width: 84rem; padding: 2rem 1.5rem; background: var(--paper); color: var(--ink);
  font: 400 16px/1.5 system-ui, "Segoe UI", Roboto, "Noto Sans", "Liberation Sans", sans-serif; }
h1, h2 { line-height: 1.2; letter-spacing: -.012em; } h2 { margin: 2.5rem 0 .4rem; }
p { color: var(--muted); max-width: 52rem; margin: .2rem 0 .8rem; }
.scroll { overflow-x: auto; background: var(--card); border: 1px solid var(--line); border-radius: 12px; }
table { border-collapse: collapse; width: 100%; font-size: .92rem; font-variant-numeric: tabular-nums; }
th, td { text-align: left; padding: .35rem .9rem; border-bottom: 1px solid var(--line); vertical-align: top; white-space: nowrap; }
td.wide { white-space: normal; min-width: 18rem; } th { color: var(--muted); font-weight: 600; }
tr:last-child td { border-bottom: 0; } a { color: var(--accent); } .bad { color: var(--warn); }
svg { display: block; margin-top: .15rem; } svg line { stroke: var(--muted); } svg rect { fill: var(--box); }
svg .middle { stroke: var(--accent); stroke-width: 2; }
)";

// Names of folders may hold anything.
std::string linkText(const std::string& path) {
  std::string out;
  for (const char c : path) {
    const auto byte = static_cast<unsigned char>(c);
    char code[4];
    std::snprintf(code, sizeof code, "%%%02X", byte);
    out += std::isalnum(byte) || std::string_view("-_./").find(c) != std::string_view::npos
               ? std::string(1, c)
               : code;
  }
  return out;
}

std::string rowHtml(const std::vector<std::string>& cells, const char* tag, const std::string& more = "") {
  std::string out = "<tr" + more + ">";
  for (const auto& cell : cells) out += std::string("<") + tag + ">" + cell + "</" + tag + ">";
  return out + "</tr>\n";
}

std::string tableHtml(const std::vector<std::string>& heads, const std::string& rows) {
  std::vector<std::string> columns;
  for (const auto& head : heads) columns.push_back(escapedForMarkup(head));
  return "<div class=\"scroll\"><table>\n" + rowHtml(columns, "th") + rows + "</table></div>\n";
}

// Least to largest as a line, quartiles as a box, the median as a mark; all variants of a figure on one
// scale.
std::string boxPlot(const Spread& s, double least, double largest) {
  if (s.count < 2 || !(largest > least)) return "";
  const auto x = [&](double value) { return 2 + 116 * (value - least) / (largest - least); };
  char text[400];
  std::snprintf(text, sizeof text,
                "<svg width=\"120\" height=\"12\" aria-hidden=\"true\"><line x1=\"%.1f\" x2=\"%.1f\" "
                "y1=\"6\" y2=\"6\"/>"
                "<rect x=\"%.1f\" y=\"2\" width=\"%.1f\" height=\"8\"/>"
                "<line class=\"middle\" x1=\"%.1f\" x2=\"%.1f\" y1=\"1\" y2=\"11\"/></svg>",
                x(s.least), x(s.largest), x(s.first_quartile),
                std::max(1.0, x(s.third_quartile) - x(s.first_quartile)), x(s.median), x(s.median));
  return text;
}

std::string spreadHtml(const Comparison& comparison) {
  const TextTable texts = spreadTable(comparison);
  std::string rows;
  for (std::size_t r = 0; r < comparison.rows.size(); ++r) {
    double least = 1e300, largest = -1e300;
    for (const auto& variant : comparison.rows[r].variants)
      if (variant.spread.count > 0) {
        least = std::min(least, variant.spread.least);
        largest = std::max(largest, variant.spread.largest);
      }
    std::vector<std::string> cells{escapedForMarkup(texts.rows[r][0])};
    for (std::size_t v = 0; v < comparison.variants.size(); ++v)
      cells.push_back(escapedForMarkup(texts.rows[r][v + 1]) +
                      boxPlot(comparison.rows[r].variants[v].spread, least, largest));
    rows += rowHtml(cells, "td");
  }
  return tableHtml(texts.columns, rows);
}

std::string differencesHtml(const Comparison& comparison) {
  const TextTable texts = differenceTable(comparison);
  if (texts.rows.empty()) return "";
  std::string rows;
  for (auto cells : texts.rows) {
    for (auto& cell : cells) cell = escapedForMarkup(cell);
    rows += rowHtml(cells, "td");
  }
  return "<h2>Differences from " + escapedForMarkup(comparison.variants.front()) +
         "</h2>\n<p>Input by input. The interval is that of the median (order statistics); p is Wilcoxon's "
         "signed-rank test, "
         "two-sided; Holm's correction counts all tests of this table. Inputs that differ only in their seed "
         "are not "
         "independent places.</p>\n" +
         tableHtml(texts.columns, rows);
}

std::string failuresHtml(const std::vector<RunLine>& runs) {
  std::string rows;
  for (const auto& run : runs)
    if (run.status != "complete")
      rows += "<tr><td>" + escapedForMarkup(run.name) + "</td><td class=\"bad\">" + escapedForMarkup(run.status) +
              "</td><td class=\"wide\">" + escapedForMarkup(run.reason) + "</td></tr>\n";
  return rows.empty() ? "" : "<h2>Without a result</h2>\n" + tableHtml({"run", "status", "reason"}, rows);
}

std::string runsHtml(const std::vector<RunLine>& runs, const PagePlaces& places) {
  std::string rows;
  for (std::size_t i = 0; i < std::min(runs.size(), kListedRuns); ++i) {
    const RunLine& run = runs[i];
    const auto link = [&](const char* file, const std::string& text) {
      return std::filesystem::exists(places.runs / run.name / file)
                 ? "<a href=\"" + linkText(places.link + "/" + run.name + "/" + file) + "\">" +
                       escapedForMarkup(text) + "</a>"
                 : escapedForMarkup(text);
    };
    char wall[40];
    std::snprintf(wall, sizeof wall, "%.1f s", run.wall_s);
    rows += rowHtml(
        {link("report.html", run.name), escapedForMarkup(run.input), run.seed ? std::to_string(*run.seed) : "",
         escapedForMarkup(run.variant), escapedForMarkup(run.status), wall, escapedForMarkup(run.revision), link("run.log", "log")},
        "td");
  }
  const std::string more = runs.size() > kListedRuns ? "<p>The first " + std::to_string(kListedRuns) +
                                                           " of " + std::to_string(runs.size()) + ".</p>\n"
                                                     : "";
  return "<h2>Runs</h2>\n" + more +
         tableHtml({"report", "input", "seed", "variant", "status", "time", "program", "log"}, rows);
}

// Groups with more than one input: for one alone there is its own report.
std::vector<std::string> groupsOfSeveral(const std::vector<RunLine>& runs) {
  std::map<std::string, std::set<std::string>> inputs;
  for (const auto& run : runs)
    if (run.status == "complete") inputs[run.group].insert(run.input);
  std::vector<std::string> groups;
  for (const auto& [group, names] : inputs)
    if (names.size() > 1) groups.push_back(group);
  return groups;
}

std::string headHtml(const std::string& title, const std::vector<RunLine>& runs, const Comparison& all) {
  std::map<std::string, int> by_status;
  for (const auto& run : runs) ++by_status[run.status];
  std::string counts;
  for (const auto& [status, count] : by_status)
    counts += (counts.empty() ? "" : ", ") + std::to_string(count) + " " + status;
  std::string revisions;
  for (const auto& revision : all.revisions) revisions += (revisions.empty() ? "" : ", ") + revision;
  return "<h1>" + escapedForMarkup(title) + "</h1>\n<p>" + std::to_string(runs.size()) + " runs: " + escapedForMarkup(counts) +
         "; " + std::to_string(all.inputs) + " inputs, " + std::to_string(all.variants.size()) +
         " variants; program " + escapedForMarkup(revisions.empty() ? "-" : revisions) + "</p>\n";
}

// Against the baseline of all where the group has it.
std::string groupHtml(const Catalogue& catalogue, ComparisonChoice choice, const std::string& group,
                      const std::string& baseline) {
  choice.group = group;
  choice.baseline.clear();
  Comparison compared = compareVariants(catalogue, choice);
  const auto& variants = compared.variants;
  if (std::find(variants.begin(), variants.end(), baseline) == variants.end())
    return "<p>* where the difference from " + escapedForMarkup(variants.front()) + " is significant.</p>\n" +
           spreadHtml(compared);
  choice.baseline = baseline;
  return spreadHtml(compareVariants(catalogue, choice));
}

}  // namespace

std::string batchPage(const Catalogue& catalogue, const ComparisonChoice& choice, const PagePlaces& places) {
  const auto runs = catalogue.runs();
  const Comparison all = compareVariants(catalogue, choice);
  std::string body = headHtml(places.title, runs, all);
  body +=
      "<h2>All inputs</h2>\n<p>Median (quartiles) over inputs and seeds, with the number of inputs in front "
      "where fewer have the "
      "figure; * where the difference from " +
      escapedForMarkup(all.variants.empty() ? "the baseline" : all.variants.front()) +
      " is significant (below).</p>\n" + spreadHtml(all);
  body += differencesHtml(all);
  if (all.groups.size() > 1)
    for (const auto& group : groupsOfSeveral(runs))
      body += "<h2>" + escapedForMarkup(group) + "</h2>\n" + groupHtml(catalogue, choice, group, all.variants.front());
  body += failuresHtml(runs) + runsHtml(runs, places);
  return std::string(
             "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<meta name=\"viewport\" "
             "content=\"width=device-width, initial-scale=1\">\n<meta http-equiv=\"Content-Security-Policy\" "
             "content=\"default-src 'none'; style-src 'unsafe-inline'\">\n<title>") +
         escapedForMarkup(places.title) + "</title>\n<style>" + kStyle + "</style>\n</head>\n<body>\n" + body +
         "</body>\n</html>\n";
}

}  // namespace roomgraph
