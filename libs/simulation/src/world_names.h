// SPDX-License-Identifier: BSD-3-Clause
// Words of world files for sides and doors, shared by their reader and their writer.
#pragma once

#include <algorithm>
#include <array>
#include <string>
#include <utility>
#include <vector>

#include "roomgraph/simulation/world.h"

namespace roomgraph {

template <class Value, std::size_t kCount>
using Words = std::array<std::pair<Value, const char*>, kCount>;

constexpr Words<Side, 4> kSideWords{
    {{Side::kNorth, "north"}, {Side::kEast, "east"}, {Side::kSouth, "south"}, {Side::kWest, "west"}}};
constexpr Words<DoorState, 4> kDoorWords{{{DoorState::kNone, "none"},
                                          {DoorState::kClosed, "closed"},
                                          {DoorState::kHalfOpen, "half_open"},
                                          {DoorState::kOpen, "open"}}};

template <class Value, std::size_t kCount>
std::vector<std::string> allWords(const Words<Value, kCount>& words) {
  std::vector<std::string> out;
  for (const auto& [value, word] : words) out.emplace_back(word);
  return out;
}

/// The value must be among `words`.
template <class Value, std::size_t kCount>
std::string wordOf(const Words<Value, kCount>& words, Value value) {
  return std::find_if(words.begin(), words.end(), [&](const auto& w) { return w.first == value; })->second;
}

/// The word must be among `words`.
template <class Value, std::size_t kCount>
Value valueOf(const Words<Value, kCount>& words, const std::string& word) {
  return std::find_if(words.begin(), words.end(), [&](const auto& w) { return w.second == word; })->first;
}

}  // namespace roomgraph
