// SPDX-License-Identifier: BSD-3-Clause
// Hungarian method with potentials and shortest augmenting paths.
#include "assignment.h"

#include <algorithm>
#include <limits>

namespace roomgraph {
namespace {

// Shortest augmenting paths with potentials on a square matrix. Indices of rows and columns begin with 1; 0 is the
// virtual start.
class Hungarian {
 public:
  explicit Hungarian(const Eigen::MatrixXd& costs)
      : costs_(costs),
        size_(static_cast<std::size_t>(costs.rows())),
        row_potential_(size_ + 1, 0),
        column_potential_(size_ + 1, 0),
        row_of_(size_ + 1, 0) {
    for (std::size_t row = 1; row <= size_; ++row) augment(row);
  }
  // Row of each column, from 1.
  const std::vector<std::size_t>& rowOf() const { return row_of_; }

 private:
  double reduced(std::size_t row, std::size_t column) const {
    return costs_(static_cast<Eigen::Index>(row - 1), static_cast<Eigen::Index>(column - 1)) -
           row_potential_[row] - column_potential_[column];
  }

  void augment(std::size_t row) {
    std::vector<double> slack(size_ + 1, std::numeric_limits<double>::infinity());
    std::vector<std::size_t> previous(size_ + 1, 0);
    std::vector<char> used(size_ + 1, 0);
    row_of_[0] = row;
    std::size_t column = 0;
    do {
      used[column] = 1;
      column = relax(column, slack, previous, used);
    } while (row_of_[column] != 0);
    for (; column != 0; column = previous[column]) row_of_[column] = row_of_[previous[column]];
  }

  // Updates the slacks from the row of `column`, moves the potentials, returns the nearest unused column.
  std::size_t relax(std::size_t column, std::vector<double>& slack, std::vector<std::size_t>& previous,
                    const std::vector<char>& used) {
    std::size_t next = 0;
    double delta = std::numeric_limits<double>::infinity();
    for (std::size_t j = 1; j <= size_; ++j) {
      if (used[j]) continue;
      const double value = reduced(row_of_[column], j);
      if (value < slack[j]) {
        slack[j] = value;
        previous[j] = column;
      }
      if (slack[j] < delta) {
        delta = slack[j];
        next = j;
      }
    }
    for (std::size_t j = 0; j <= size_; ++j) {
      if (used[j]) {
        row_potential_[row_of_[j]] += delta;
        column_potential_[j] -= delta;
      } else {
        slack[j] -= delta;
      }
    }
    return next;
  }

  const Eigen::MatrixXd& costs_;
  std::size_t size_;
  std::vector<double> row_potential_, column_potential_;
  std::vector<std::size_t> row_of_;
};

}  // namespace

std::vector<int> assignWithinGate(const Eigen::MatrixXd& costs, double gate) {
  std::vector<int> column_of(static_cast<std::size_t>(costs.rows()), -1);
  const Eigen::Index size = std::max(costs.rows(), costs.cols());
  if (costs.size() == 0) return column_of;
  // More than any sum of allowed costs: the number of pairs has priority.
  const double forbidden = (gate + 1) * static_cast<double>(size + 1);
  Eigen::MatrixXd square = Eigen::MatrixXd::Constant(size, size, forbidden);
  for (Eigen::Index i = 0; i < costs.rows(); ++i)
    for (Eigen::Index j = 0; j < costs.cols(); ++j)
      if (costs(i, j) <= gate) square(i, j) = costs(i, j);
  const Hungarian solved(square);
  for (Eigen::Index j = 0; j < costs.cols(); ++j) {
    const Eigen::Index i = static_cast<Eigen::Index>(solved.rowOf()[static_cast<std::size_t>(j) + 1]) - 1;
    if (i < costs.rows() && costs(i, j) <= gate) column_of[static_cast<std::size_t>(i)] = static_cast<int>(j);
  }
  return column_of;
}

}  // namespace roomgraph
