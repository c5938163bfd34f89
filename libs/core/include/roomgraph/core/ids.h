// SPDX-License-Identifier: BSD-3-Clause
// Strongly typed integer ids of frames, nodes, landmarks and tracks.
#pragma once

#include <compare>
#include <cstdint>
#include <functional>
#include <ostream>

namespace roomgraph {

/// Integer id with a type of its own for every kind. Negative means "none".
template <class Tag>
struct Id {
  std::int64_t value = -1;

  constexpr bool valid() const { return value >= 0; }
  constexpr auto operator<=>(const Id&) const = default;  // NOLINT(modernize-use-nullptr): there is no pointer
  friend std::ostream& operator<<(std::ostream& out, Id id) { return out << id.value; }
};

using FrameId = Id<struct FrameTag>;        ///< one RGB-D frame, counted from 0 in the order of the input
using NodeId = Id<struct NodeTag>;          ///< one robot pose in the factor graph
using LandmarkId = Id<struct LandmarkTag>;  ///< one object in the map
using TrackId = Id<struct TrackTag>;        ///< one detection followed over consecutive frames

}  // namespace roomgraph

template <class Tag>
struct std::hash<roomgraph::Id<Tag>> {
  std::size_t operator()(roomgraph::Id<Tag> id) const noexcept { return std::hash<std::int64_t>{}(id.value); }
};
