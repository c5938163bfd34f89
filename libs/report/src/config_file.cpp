// SPDX-License-Identifier: BSD-3-Clause
// INI entries compared as texts and numbers; colours; evaluation files.
#include "config_file.h"

#include <algorithm>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <set>

#include "roomgraph/core/ini_text.h"
#include "roomgraph/core/json_integer.h"
#include "roomgraph/core/text_file.h"

namespace roomgraph {
namespace {

using nlohmann::json;

constexpr std::uintmax_t kLargestEvaluation = 4 << 20;

bool sameValue(const std::string& a, const std::string& b) {
  if (a == b) return true;
  char *end_a = nullptr, *end_b = nullptr;
  const double x = std::strtod(a.c_str(), &end_a), y = std::strtod(b.c_str(), &end_b);
  return !a.empty() && !b.empty() && *end_a == 0 && *end_b == 0 && x == y;
}

bool isColour(const std::string& text) {
  return text.size() == 7 && text[0] == '#' &&
         text.find_first_not_of("0123456789abcdefABCDEF", 1) == std::string::npos;
}

std::vector<ReliabilityRow> reliabilityOf(const json& content) {
  std::vector<ReliabilityRow> rows;
  if (!content.contains("association_reliability")) return rows;
  for (const json& bin : content.at("association_reliability")) {
    if (integerOf<int>(bin.at("count")) == 0) continue;
    rows.push_back(
        {bin.at("from"), bin.at("to"), bin.at("mean_probability"), bin.at("correct_share"), bin.at("count")});
  }
  return rows;
}

bool isEvaluation(const json& content) {
  constexpr std::array kTokens{"ate_rmse_m", "trans_abs_rmse_m", "precision", "association_accuracy", "occupied_recall"};
  return content.is_object() &&
         std::any_of(kTokens.begin(), kTokens.end(), [&](const char* key) { return content.contains(key); });
}

}  // namespace

std::vector<ConfigRow> readConfigRows(const std::filesystem::path& file,
                                      const std::map<std::string, std::vector<std::string>>& defaults) {
  std::vector<ConfigRow> rows;
  for (const auto& entry : parseIniFile(file)) {
    ConfigRow row{entry.section, entry.key, entry.value, "", false};
    if (const auto known = defaults.find(entry.section + "." + entry.key); known != defaults.end()) {
      const auto& texts = known->second;
      row.shipped = texts.empty() ? "" : texts.front();
      row.changed = std::none_of(texts.begin(), texts.end(),
                                 [&](const std::string& text) { return sameValue(text, entry.value); });
    }
    rows.push_back(row);
  }
  return rows;
}

std::map<std::string, std::string> readColours(const std::filesystem::path& file) {
  std::map<std::string, std::string> colours;
  for (const auto& entry : parseIniFile(file))
    if (entry.key == "color" && isColour(entry.value)) colours[entry.section] = entry.value;
  return colours;
}

std::vector<EvaluationFile> readEvaluations(const std::filesystem::path& folder) {
  const std::set<std::string> own{"landmarks.json", "candidates.json", "summary.json"};
  std::vector<EvaluationFile> out;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    if (entry.path().extension() != ".json" || own.contains(name) || !entry.is_regular_file() ||
        entry.file_size() > kLargestEvaluation)
      continue;
    try {
      const json content = json::parse(readTextFile(entry.path()));
      if (!isEvaluation(content)) continue;
      EvaluationFile file{name, {}, reliabilityOf(content)};
      for (const auto& [key, value] : content.items())
        if (value.is_number()) file.figures[key] = value.get<double>();
      out.push_back(std::move(file));
    } catch (const std::exception&) {
      continue;  // somebody else's file
    }
  }
  std::sort(out.begin(), out.end(), [](const auto& a, const auto& b) { return a.name < b.name; });
  return out;
}

}  // namespace roomgraph
