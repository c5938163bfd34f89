// SPDX-License-Identifier: BSD-3-Clause
// Reading order of boxes, longest common subsequence, and identity links between frames.
#include "semantic_code.h"

#include <algorithm>
#include <numeric>
#include <stdexcept>
#include <tuple>
#include <utility>

namespace roomgraph {

std::uint8_t LabelCodes::of(const std::string& class_name) {
  const auto found = std::find(names_.begin(), names_.end(), class_name);
  const auto code = found - names_.begin();
  if (code > 255) throw std::length_error("semantic code: more than 256 classes, at '" + class_name + "'");
  if (found == names_.end()) names_.push_back(class_name);
  return static_cast<std::uint8_t>(code);
}

SemanticCode semanticCode(const std::vector<LabelledBox>& objects) {
  const auto box = [&](int i) -> const Box2& { return objects[static_cast<std::size_t>(i)].box; };
  SemanticCode code;
  code.objects.resize(objects.size());
  std::iota(code.objects.begin(), code.objects.end(), 0);
  auto row = code.objects.begin();
  while (row != code.objects.end()) {
    const auto highest = std::min_element(row, code.objects.end(), [&](int i, int k) {
      return std::pair(box(i).v_min, i) < std::pair(box(k).v_min, k);
    });
    const int first = *highest;
    const auto next = std::partition(
        row, code.objects.end(), [&](int i) { return i == first || box(i).center().y() < box(first).v_max; });
    std::sort(row, next, [&](int i, int k) {
      return std::pair(box(i).center().x(), i) < std::pair(box(k).center().x(), k);
    });
    row = next;
  }
  for (const int i : code.objects) code.labels.push_back(objects[static_cast<std::size_t>(i)].label);
  return code;
}

CodeMatch matchCodes(const SemanticCode& a, const SemanticCode& b, const Eigen::MatrixXd& overlap) {
  using Value = std::pair<int, double>;  // labels matched, then overlaps: compared in this order
  const std::size_t n = a.labels.size(), m = b.labels.size();
  const auto linked = [&](const Value& rest, std::size_t i, std::size_t k) {
    return Value{rest.first + 1, rest.second + overlap(a.objects[i], b.objects[k])};
  };
  // best[i][k]: for the rest of a from i on and of b from k on.
  std::vector<std::vector<Value>> best(n + 1, std::vector<Value>(m + 1));
  for (std::size_t i = n; i-- > 0;)
    for (std::size_t k = m; k-- > 0;) {
      best[i][k] = std::max(best[i + 1][k], best[i][k + 1]);
      if (a.labels[i] == b.labels[k]) best[i][k] = std::max(best[i][k], linked(best[i + 1][k + 1], i, k));
    }

  CodeMatch match;
  match.gamma.assign(m, -1);
  for (std::size_t i = 0, k = 0; i < n && k < m;) {
    if (a.labels[i] == b.labels[k] && best[i][k] == linked(best[i + 1][k + 1], i, k)) {
      match.gamma[static_cast<std::size_t>(b.objects[k++])] = a.objects[i++];
    } else if (best[i][k] == best[i + 1][k]) {
      ++i;
    } else {
      ++k;
    }
  }
  const int common = 8 * best[0][0].first, all = a.bits() + b.bits() - common;
  if (all > 0) match.beta = static_cast<double>(common) / all;
  return match;
}

std::vector<int> identityLinks(const SemanticCode& a, const SemanticCode& b, const CodeMatch& match,
                               const Eigen::MatrixXd& overlap, double min_overlap, double order_bonus) {
  std::vector<std::tuple<double, int, int>> candidates;  // (-support, object of a, object of b)
  for (std::size_t p = 0; p < a.labels.size(); ++p)
    for (std::size_t q = 0; q < b.labels.size(); ++q) {
      const int i = a.objects[p], k = b.objects[q];
      if (a.labels[p] != b.labels[q] || overlap(i, k) < min_overlap) continue;
      const bool agreed = match.gamma[static_cast<std::size_t>(k)] == i;
      candidates.emplace_back(-overlap(i, k) - (agreed ? order_bonus : 0), i, k);
    }
  std::sort(candidates.begin(), candidates.end());
  std::vector<int> links(b.labels.size(), -1);
  std::vector<bool> taken(a.labels.size(), false);
  for (const auto& [support, i, k] : candidates) {
    if (taken[static_cast<std::size_t>(i)] || links[static_cast<std::size_t>(k)] >= 0) continue;
    taken[static_cast<std::size_t>(i)] = true;
    links[static_cast<std::size_t>(k)] = i;
  }
  return links;
}

}  // namespace roomgraph
