// SPDX-License-Identifier: BSD-3-Clause
// Rounds of matching and solving; directions that the evidence does not fix.
#include "estimate_calibration.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "coarse_offsets.h"
#include "roomgraph/core/errors.h"
#include "roomgraph/geometry/degree.h"

namespace roomgraph {
namespace {

constexpr double kBeliefWidth = 15;  // of the former value, in units of what counts as unknown
constexpr double kFrozen = 1e-3;     // of a direction that is not fixed, in the same units
constexpr double kFirstFactor = 15;  // what the wrong calibration misses must not look like an outlier
constexpr double kLeastFactor = 0.1, kMostFactor = 50;  // on nominal standard deviations
constexpr double kPartly = 0.15, kUnfixed = 0.5, kWholly = 0.999;  // share of a parameter's axis that is not fixed
const std::vector<MatchGate> kGates{{0.35, 0.35}, {0.2, 0.3}, {0.12, 0.25}, {0.08, 0.2}, {0.08, 0.2}};

ParameterVector unknownFrom() {
  ParameterVector out;
  for (int i = 0; i < kParameterCount; ++i)
    out[i] = parameterTraits()[static_cast<std::size_t>(i)].unknown_from;
  return out;
}

FormerBelief weakBelief(const CalibrationTask& task) {
  Eigen::MatrixXd rows(kParameterCount - static_cast<int>(task.held.count()), kParameterCount);
  rows.setZero();
  int row = 0;
  const ParameterVector unit = unknownFrom();
  for (int i = 0; i < kParameterCount; ++i)
    if (!task.held[static_cast<std::size_t>(i)]) rows(row++, i) = 1 / (kBeliefWidth * unit[i]);
  return {rows};
}

// Directions in units of what counts as unknown, unit vectors in columns.
Eigen::MatrixXd unfixedDirections(const ParameterMatrix& covariance) {
  const ParameterVector unit = unknownFrom();
  const ParameterMatrix scaled =
      unit.cwiseInverse().asDiagonal() * covariance * unit.cwiseInverse().asDiagonal();
  const Eigen::SelfAdjointEigenSolver<ParameterMatrix> axes(scaled);
  int first = kParameterCount;
  while (first > 0 && axes.eigenvalues()[first - 1] > 1) --first;
  return axes.eigenvectors().rightCols(kParameterCount - first);
}

FormerBelief frozen(const Eigen::MatrixXd& directions) {
  return {directions.transpose() * unknownFrom().cwiseInverse().asDiagonal() / kFrozen};
}

// What only combinations of parameters tell stays told: a lidar and a camera that nothing places on the robot still have
// their place to each other.
void stayAlong(const Eigen::MatrixXd& directions, const ParameterVector& before, ParameterVector& after) {
  const ParameterVector unit = unknownFrom();
  const ParameterVector change = unit.cwiseInverse().asDiagonal() * (after - before);
  after = before + unit.asDiagonal() * ParameterVector(change - directions * (directions.transpose() * change));
}

std::string inWords(const Eigen::VectorXd& direction) {
  std::string out;
  for (int i = 0; i < kParameterCount; ++i)
    if (std::abs(direction[i]) > 0.3)
      out += (out.empty() ? "" : " with ") + std::string(parameterTraits()[static_cast<std::size_t>(i)].name);
  return out;
}

void setKnowledge(const CalibrationTask& task, const Eigen::MatrixXd& directions, CalibrationEstimate& out) {
  for (int i = 0; i < kParameterCount; ++i) {
    const double share = directions.cols() > 0 ? directions.row(i).squaredNorm() : 0;
    out.knowledge[static_cast<std::size_t>(i)] = task.held[static_cast<std::size_t>(i)] ? Knowledge::kHeld
                                                 : share > kUnfixed                     ? Knowledge::kUnfixed
                                                 : share > kPartly                      ? Knowledge::kPartly
                                                                                        : Knowledge::kFixed;
  }
  for (int k = 0; k < directions.cols(); ++k) out.unfixed.push_back(inWords(directions.col(k)));
}

void report(const CalibrationProblem& problem, const NoiseFactors& noise, CalibrationEstimate& out) {
  out.measurements = {{"walls", problem.count(NoiseKind::kWall)},
                      {"floor patches", problem.count(NoiseKind::kFloor)},
                      {"camera movements", problem.count(NoiseKind::kCameraTurn)},
                      {"wheel movements", problem.count(NoiseKind::kWheelForward)}};
  if (const int pairs = problem.count(NoiseKind::kBoardTurn)) out.measurements["pairs of views of the board"] = pairs;
  if (const int depths = problem.count(NoiseKind::kBoardDepth)) out.measurements["depths of the board"] = depths;
  const char* const names[kNoiseKinds] = {"wall",        "floor",       "camera turn", "camera movement", "wheels forward",
                                          "wheels side", "wheels turn", "board turn",  "board place",     "board depth"};
  for (std::size_t k = 0; k < kNoiseKinds; ++k) out.noise[names[k]] = noise[k];
}

}  // namespace

CalibrationEstimate estimateCalibration(const CalibrationTask& given,
                                        const std::function<void(double)>& progress) {
  CalibrationEstimate out;
  out.before = given.before;
  ParameterVector values = given.before;
  // Without turns noise alone would seem to tell time offsets.
  const std::bitset<kParameterCount> unknown = addCoarseOffsets(given, values);
  CalibrationTask task = given;
  task.held |= unknown;
  NoiseFactors noise;
  noise.fill(kFirstFactor);
  const FormerBelief weak = weakBelief(task);
  for (std::size_t round = 0; round < kGates.size(); ++round) {
    if (progress) progress(static_cast<double>(round) / static_cast<double>(kGates.size() + 1));
    CalibrationProblem problem(task, noise, {weak}, values, kGates[round]);
    problem.solve();
    values = problem.parameters();
    const auto scatter = problem.scatter();
    for (std::size_t k = 0; k < kNoiseKinds; ++k)
      noise[k] = std::clamp(noise[k] * scatter[k], kLeastFactor, kMostFactor);
  }
  CalibrationProblem problem(task, noise, {weak}, values, kGates.back());
  report(problem, noise, out);
  if (std::all_of(out.measurements.begin(), out.measurements.end(),
                  [](const auto& kind) { return kind.second == 0; }))
    throw RunError("nothing in the recording says anything about the calibration");
  problem.solve();
  const ParameterMatrix covariance = problem.covariance();
  const Eigen::MatrixXd directions = unfixedDirections(covariance);
  setKnowledge(task, directions, out);
  for (int i = 0; i < kParameterCount; ++i) {
    if (!unknown[static_cast<std::size_t>(i)]) continue;
    out.knowledge[static_cast<std::size_t>(i)] = Knowledge::kUnfixed;
    out.unfixed.emplace_back(parameterTraits()[static_cast<std::size_t>(i)].name);
  }
  out.after = problem.parameters();
  out.covariance = covariance;
  if (directions.cols() == 0) return out;
  CalibrationProblem rest(task, noise, {weak, frozen(directions)}, problem.parameters(), kGates.back());
  rest.solve();
  out.after = rest.parameters();
  stayAlong(directions, task.before, out.after);
  for (int i = 0; i < kParameterCount; ++i)
    if (unknown[static_cast<std::size_t>(i)] || directions.row(i).squaredNorm() > kWholly) out.after[i] = task.before[i];
  if (progress) progress(1);
  return out;
}

}  // namespace roomgraph
