// SPDX-License-Identifier: BSD-3-Clause
// Semantic codes of frames and their matching (paper Eq. 5).
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "roomgraph/geometry/box.h"

namespace roomgraph {

/// Binary codes of class names: one byte each, numbered in the order in which they are first asked for.
/// Ratios of code lengths (Eq. 5) do not depend on the numbering or the width.
class LabelCodes {
 public:
  /// Throws std::length_error at the 257th name.
  std::uint8_t of(const std::string& class_name);

 private:
  std::vector<std::string> names_;
};

/// An object in an image, for its semantic code.
struct LabelledBox {
  Box2 box;
  std::uint8_t label = 0;
};

/// Semantic code of a frame (paper sec. V-B2, method.md sec. 2): the bytes of its labels in
/// reading order.
struct SemanticCode {
  std::vector<std::uint8_t> labels;  ///< in reading order
  std::vector<int> objects;          ///< index of the object at each position
  int bits() const { return 8 * static_cast<int>(labels.size()); }
};

/// Reading order: a row begins with the highest remaining box and contains all whose centres are above its bottom
/// side; rows from top to bottom, inside a row by the centre's column.
SemanticCode semanticCode(const std::vector<LabelledBox>& objects);

/// Matching of two codes.
struct CodeMatch {
  double beta = 1;         ///< Eq. 5, in [0, 1]; 1 for two empty codes
  std::vector<int> gamma;  ///< per object of b the object of a that it matches, -1: none
};

/// Longest common subsequence of the labels; of several, that with the largest sum of overlaps.
/// `overlap(i, k)` >= 0: of the predicted box of object i of a with object k of b.
CodeMatch matchCodes(const SemanticCode& a, const SemanticCode& b, const Eigen::MatrixXd& overlap);

/// Data association of objects from a to b; per object of b the object of a, -1: none. Gamma alone does not
/// suffice: it swaps two chairs that change their reading order, and links any two chairs when no others are
/// left. So only pairs of one label with an overlap of at least `min_overlap` (> 0) are linked, the largest
/// first; pairs that gamma links get the bonus `order_bonus`, which decides between similar overlaps.
std::vector<int> identityLinks(const SemanticCode& a, const SemanticCode& b, const CodeMatch& match,
                               const Eigen::MatrixXd& overlap, double min_overlap, double order_bonus);

}  // namespace roomgraph
