// SPDX-License-Identifier: BSD-3-Clause
// Reading of texts and lists from bytes whose lengths may be damaged.
#pragma once

#include <mrpt/serialization/CArchive.h>

#include <algorithm>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace roomgraph {

/// A list as MRPT's archives hold strings and vectors of numbers: its length, then its elements. Memory grows with the
/// elements that are there, where MRPT's own readers take what the length says, up to 16 GB. Throws std::runtime_error where
/// the archive ends before.
template <class List>
List readGrowing(mrpt::serialization::CArchive& in) {
  using Element = typename List::value_type;
  constexpr std::size_t kPiece = 65536 / sizeof(Element);
  List out;
  for (std::size_t left = in.ReadAs<std::uint32_t>(); left > 0;) {
    const std::size_t begin = out.size(), piece = std::min(left, kPiece);
    out.resize(begin + piece);
    const std::size_t bytes = in.ReadBuffer(&out[begin], piece * sizeof(Element));
    if (bytes != piece * sizeof(Element)) throw std::runtime_error("EOF within a list");
    left -= piece;
  }
  return out;
}

inline std::string readText(mrpt::serialization::CArchive& in) {
  return readGrowing<std::string>(in);
}

/// As many elements as a number before them says, each by `read`.
template <class Read>
auto readList(mrpt::serialization::CArchive& in, Read read) {
  std::vector<decltype(read(in))> out;
  for (auto left = in.ReadAs<std::uint32_t>(); left > 0; --left) out.push_back(read(in));
  return out;
}

}  // namespace roomgraph
