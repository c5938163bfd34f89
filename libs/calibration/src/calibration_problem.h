// SPDX-License-Identifier: BSD-3-Clause
// The least-squares problem of a calibration: residuals of all recordings, one vector of parameters.
#pragma once

#include <ceres/problem.h>

#include <bitset>
#include <vector>

#include "measurement_noise.h"
#include "sensor_costs.h"

namespace roomgraph {

/// What a calibration starts from.
struct CalibrationTask {
  std::vector<RecordingEvidence> evidence;
  ParameterVector before = ParameterVector::Zero();
  std::bitset<kParameterCount> held;  ///< not estimated
  double lidar_z_m = 0;               ///< above the floor, as recorded
};

/// Belief that the parameters are near their former values along some directions: the rows of `directions`
/// times the difference to these have standard deviation 1.
struct FormerBelief {
  Eigen::MatrixXd directions;
};

/// The problem at given matches and noise. `parameters` is where it starts, and where the solution is found.
class CalibrationProblem {
 public:
  CalibrationProblem(const CalibrationTask& task, const NoiseFactors& noise,
                     const std::vector<FormerBelief>& beliefs, const ParameterVector& parameters,
                     const MatchGate& gate);

  /// Levenberg-Marquardt. Throws RunError when it fails.
  void solve();
  const ParameterVector& parameters() const { return parameters_; }
  /// Factors on the standard deviations of the kinds by which the residuals scatter more, or less, than
  /// assumed; back to the nominal ones for kinds of which there are few.
  NoiseFactors scatter() const;
  /// Inverse information of the parameters; zero for held ones.
  ParameterMatrix inverseInformation();
  /// The same with the scatter of gradients over time in place of assumed independence (sandwich estimator;
  /// Newey and West 1987).
  ParameterMatrix covariance();
  /// Used measurements of a kind.
  int count(NoiseKind kind) const;

 private:
  struct Block {
    ceres::ResidualBlockId id;
    int recording;
    double t;                      ///< s
    std::vector<NoiseKind> kinds;  ///< of its residuals
  };
  using Jacobian = Eigen::Matrix<double, 6, kParameterCount, Eigen::RowMajor>;
  Jacobian jacobianOf(const Block& block, std::array<double, 6>& residuals) const;
  void addWheels(const RecordingEvidence& recording, int index);
  void addViews(const RecordingEvidence& recording, int index, const MatchGate& gate);
  void addSteps(const RecordingEvidence& recording, int index);
  void addBoards(const RecordingEvidence& recording, int index);
  void add(ceres::CostFunction* cost, int recording, double t, std::vector<NoiseKind> kinds);
  double sigma(NoiseKind kind, double nominal) const {
    return nominal * noise_[static_cast<std::size_t>(kind)];
  }

  const CalibrationTask& task_;
  NoiseFactors noise_;
  ParameterVector parameters_;
  ParameterMatrix belief_ = ParameterMatrix::Zero();  ///< information of the beliefs
  ceres::Problem problem_;
  std::vector<Block> blocks_;  ///< of measurements
};

}  // namespace roomgraph
