// SPDX-License-Identifier: BSD-3-Clause
// Parsing of associations.txt, rgb.txt and depth.txt; greedy pairing by time difference.
#include "roomgraph/datasets/tum_lists.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <optional>
#include <sstream>
#include <tuple>

#include "roomgraph/core/errors.h"
#include "roomgraph/observations/image_file.h"

namespace roomgraph {
namespace {

namespace fs = std::filesystem;

std::optional<double> toNumber(const std::string& text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

/// Words of every line that is neither empty nor a comment.
std::vector<std::vector<std::string>> readRows(const fs::path& file) {
  std::ifstream in(file);
  if (!in) throw InputError(file.string() + ": cannot be read");
  std::vector<std::vector<std::string>> rows;
  for (std::string line; std::getline(in, line);) {
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream words(line);
    std::vector<std::string> row;
    for (std::string word; words >> word;) row.push_back(word);
    if (!row.empty() && row[0][0] != '#') rows.push_back(std::move(row));
  }
  return rows;
}

void warnOfRows(const fs::path& file, int count, std::vector<std::string>& warnings) {
  if (count > 0)
    warnings.push_back(file.filename().string() + ": " + std::to_string(count) +
                       " lines left out: not understood");
}

struct Row {
  TumEntry first, second;
};

std::vector<Row> readAssociations(const fs::path& file, std::vector<std::string>& warnings) {
  std::vector<Row> rows;
  int odd = 0;
  for (const auto& row : readRows(file)) {
    const auto t_first = row.size() == 4 ? toNumber(row[0]) : std::nullopt;
    const auto t_second = row.size() == 4 ? toNumber(row[2]) : std::nullopt;
    if (t_first && t_second)
      rows.push_back({{*t_first, row[1]}, {*t_second, row[3]}});
    else
      ++odd;
  }
  warnOfRows(file, odd, warnings);
  return rows;
}

/// Which column is depth: told by the first row whose files can be read (16 bit against 8 bit), otherwise by
/// the name.
bool depthComesFirst(const fs::path& folder, const std::vector<Row>& rows) {
  for (const auto& row : rows) {
    const cv::Mat first = readImageFile(folder / row.first.file, cv::IMREAD_UNCHANGED);
    const cv::Mat second = readImageFile(folder / row.second.file, cv::IMREAD_UNCHANGED);
    if (first.empty() || second.empty()) continue;
    if ((first.depth() == CV_16U) != (second.depth() == CV_16U)) return first.depth() == CV_16U;
  }
  return !rows.empty() && rows.front().first.file.find("depth") != std::string::npos;
}

std::vector<TumPair> fromAssociations(const fs::path& folder, const fs::path& file,
                                      std::vector<std::string>& warnings) {
  const auto rows = readAssociations(file, warnings);
  const bool depth_first = depthComesFirst(folder, rows);
  std::vector<TumPair> pairs;
  for (const auto& row : rows) {
    const auto& color = depth_first ? row.second : row.first;
    const auto& depth = depth_first ? row.first : row.second;
    pairs.push_back({color.t, folder / color.file, folder / depth.file});
  }
  return pairs;
}

std::vector<TumPair> fromTwoLists(const fs::path& folder, double max_difference_s,
                                  std::vector<std::string>& warnings) {
  const auto color = readTumEntries(folder / "rgb.txt", warnings),
             depth = readTumEntries(folder / "depth.txt", warnings);
  std::vector<TumPair> pairs;
  for (const auto& [i, j] : pairByTime(color, depth, max_difference_s))
    pairs.push_back({color[i].t, folder / color[i].file, folder / depth[j].file});
  if (pairs.size() < color.size())
    warnings.push_back(std::to_string(color.size() - pairs.size()) + " of " + std::to_string(color.size()) +
                       " colour images left out: no depth image within " +
                       std::to_string(std::lround(1000 * max_difference_s)) + " ms");
  return pairs;
}

}  // namespace

std::vector<TumEntry> readTumEntries(const fs::path& file, std::vector<std::string>& warnings) {
  std::vector<TumEntry> entries;
  int odd = 0;
  for (const auto& row : readRows(file)) {
    const auto t = row.size() == 2 ? toNumber(row[0]) : std::nullopt;
    if (t)
      entries.push_back({*t, row[1]});
    else
      ++odd;
  }
  warnOfRows(file, odd, warnings);
  return entries;
}

std::vector<std::pair<std::size_t, std::size_t>> pairByTime(const std::vector<TumEntry>& color,
                                                            const std::vector<TumEntry>& depth,
                                                            double max_difference_s) {
  std::vector<std::size_t> by_time(depth.size());
  for (std::size_t j = 0; j < depth.size(); ++j) by_time[j] = j;
  std::stable_sort(by_time.begin(), by_time.end(), [&](auto a, auto b) { return depth[a].t < depth[b].t; });
  std::vector<std::tuple<double, std::size_t, std::size_t>> candidates;
  for (std::size_t i = 0; i < color.size(); ++i) {
    auto j = std::lower_bound(by_time.begin(), by_time.end(), color[i].t - max_difference_s,
                              [&](std::size_t index, double t) { return depth[index].t < t; });
    for (; j != by_time.end() && depth[*j].t <= color[i].t + max_difference_s; ++j)
      candidates.emplace_back(std::abs(depth[*j].t - color[i].t), i, *j);
  }
  std::sort(candidates.begin(), candidates.end());
  std::vector<char> color_taken(color.size()), depth_taken(depth.size());
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  for (const auto& [difference, i, j] : candidates) {
    if (color_taken[i] || depth_taken[j]) continue;
    color_taken[i] = depth_taken[j] = 1;
    pairs.emplace_back(i, j);
  }
  std::sort(pairs.begin(), pairs.end(), [&](const auto& a, const auto& b) {
    return std::tie(color[a.first].t, a) < std::tie(color[b.first].t, b);
  });
  return pairs;
}

std::vector<TumPair> readTumPairs(const fs::path& folder, double max_difference_s,
                                  std::vector<std::string>& warnings) {
  if (!fs::is_directory(folder)) throw InputError(folder.string() + ": no such folder");
  std::vector<TumPair> pairs;
  fs::path list;
  for (const char* name : {"associations.txt", "association.txt", "associate.txt"})
    if (list.empty() && fs::exists(folder / name)) list = folder / name;
  if (!list.empty())
    pairs = fromAssociations(folder, list, warnings);
  else if (fs::exists(folder / "rgb.txt") && fs::exists(folder / "depth.txt"))
    pairs = fromTwoLists(folder, max_difference_s, warnings);
  else
    throw InputError(folder.string() + ": has neither associations.txt nor rgb.txt and depth.txt");
  if (pairs.empty()) throw InputError(folder.string() + ": no pair of colour and depth images listed");

  std::stable_sort(pairs.begin(), pairs.end(), [](const auto& a, const auto& b) { return a.t < b.t; });
  const auto repeated =
      std::unique(pairs.begin(), pairs.end(), [](const auto& a, const auto& b) { return a.t == b.t; });
  if (repeated != pairs.end())
    warnings.push_back(std::to_string(pairs.end() - repeated) +
                       " pairs left out: same time stamp as another");
  pairs.erase(repeated, pairs.end());
  return pairs;
}

}  // namespace roomgraph
