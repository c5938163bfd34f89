// SPDX-License-Identifier: BSD-3-Clause
// Residual blocks of a calibration, their solution with Ceres, and covariances.
#include "calibration_problem.h"

#include <ceres/ceres.h>
#include <ceres/normal_prior.h>
#include <glog/logging.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <map>

#include "roomgraph/core/errors.h"
#include "roomgraph/core/order_statistics.h"

namespace roomgraph {
namespace {

constexpr double kRobust = 2.5;        // standard deviations
constexpr double kPathMargin_s = 0.3;  // as much as times may move while solving
constexpr double kShortWheels_s = 0.3, kLongWheels_s = 0.6, kStandsStill = 0.02;  // the last in m + rad
constexpr double kTurnSigma_rad = 0.002, kMoveSigma_m = 0.004;  // of visual odometry between two images
constexpr double kBoardTurn_rad = 0.002, kBoardPlace_m = 0.003;  // of the lidar's path between two images
constexpr double kBoardTurned_rad = 0.1, kBoardMoved_m = 0.15, kBoardLongest_s = 20;
constexpr std::size_t kLeastResiduals = 8;                      // of fewer the scatter says nothing
constexpr double kBin_s = 0.5;                                  // of gradients that are added up
constexpr double kMostOfAll = 0.95;                               // of what is known of a parameter, by one bin
constexpr int kLags = 4;                                        // bins over which errors may hang together

double sigmaOf(const WallMatch& match) {
  return std::hypot(match.wall_sigma_m, patchSigma(match.patch.point.z()));
}

// Of the distance between the depth on a board and its plane.
double depthSigma(const BoardView& view) {
  const Eigen::Vector3d normal = view.camera_from_board.linear().col(2);
  return std::hypot(std::sqrt(normal.dot(view.place_covariance * normal)), patchSigma(view.depth->point.z()));
}

double lengthOf(const WheelMovement& movement) {
  double out = 0;
  for (const auto& step : movement.read) out += std::hypot(step[0], step[1]);
  return out;
}

double turnOf(const WheelMovement& movement) {
  double out = 0;
  for (const auto& step : movement.read) out += std::abs(step[2]);
  return out;
}

std::vector<WheelMovement> wheelMovements(const RecordingEvidence& recording, const PlanarPath& wheels,
                                          double offset, double seconds) {
  std::vector<WheelMovement> out;
  WheelMovement now{nullptr, wheels.time(0), 0, {}};
  for (std::size_t i = 1; i < wheels.size(); ++i) {
    now.read.push_back(planarBetween(wheels.values(i - 1), wheels.values(i)));
    now.t_b = wheels.time(i);
    if (now.t_b - now.t_a < seconds) continue;
    now.lidar = pathAt(recording.lidar, now.t_a + offset, kPathMargin_s);
    if (now.lidar && now.lidar->covers(now.t_b + offset, kPathMargin_s) && now.t_b - now.t_a < 2 * seconds &&
        lengthOf(now) + turnOf(now) > kStandsStill)
      out.push_back(now);
    now = {nullptr, wheels.time(i), 0, {}};
  }
  return out;
}

struct BoardPair {
  const PlanarPath* lidar;
  const BoardView *before, *after;
};

// Each view with the first later one that shows the board clearly elsewhere, and with the one that shows it farthest from
// there: such pairs say where the camera sits, as the same board from the same place would not.
std::vector<BoardPair> boardPairs(const RecordingEvidence& recording, double offset_s) {
  std::vector<BoardPair> out;
  const auto& views = recording.boards;
  for (auto a = views.begin(); a != views.end(); ++a) {
    const PlanarPath* path = pathAt(recording.lidar, a->t + offset_s, kPathMargin_s);
    const BoardView *first = nullptr, *farthest = nullptr;
    double most = 1;
    for (auto b = a + 1; path && b != views.end() && b->t - a->t < kBoardLongest_s; ++b) {
      if (!path->covers(b->t + offset_s, kPathMargin_s)) break;
      const Pose3 moved = a->camera_from_board * b->camera_from_board.inverse();
      const double far = moved.translation().norm() / kBoardMoved_m + rotationAngle(moved) / kBoardTurned_rad;
      if (far < most) continue;
      if (!first) first = &*b;
      most = far;
      farthest = &*b;
    }
    if (first) out.push_back({path, &*a, first});
    if (farthest != first) out.push_back({path, &*a, farthest});
  }
  return out;
}

// The root of the information of a sum of errors with these covariances.
Eigen::Matrix3d rootInformation(const Eigen::Matrix3d& covariance, double factor) {
  const Eigen::Matrix3d lower = covariance.llt().matrixL();
  return lower.triangularView<Eigen::Lower>().solve(Eigen::Matrix3d::Identity()) / factor;
}

}  // namespace

CalibrationProblem::CalibrationProblem(const CalibrationTask& task, const NoiseFactors& noise,
                                       const std::vector<FormerBelief>& beliefs,
                                       const ParameterVector& parameters, const MatchGate& gate)
    : task_(task), noise_(noise), parameters_(parameters) {
  problem_.AddParameterBlock(parameters_.data(), kParameterCount);
  std::vector<int> constant;
  for (int i = 0; i < kParameterCount; ++i)
    if (task.held[static_cast<std::size_t>(i)]) constant.push_back(i);
  if (static_cast<int>(constant.size()) == kParameterCount)
    problem_.SetParameterBlockConstant(parameters_.data());
  else if (!constant.empty())
    problem_.SetManifold(parameters_.data(), new ceres::SubsetManifold(kParameterCount, constant));
  for (const auto& belief : beliefs) {
    if (belief.directions.rows() == 0) continue;
    problem_.AddResidualBlock(new ceres::NormalPrior(belief.directions, task.before), nullptr,
                              parameters_.data());
    belief_ += belief.directions.transpose() * belief.directions;
  }
  for (std::size_t i = 0; i < task.evidence.size(); ++i) {
    const int index = static_cast<int>(i);
    addWheels(task.evidence[i], index);
    addViews(task.evidence[i], index, gate);
    addSteps(task.evidence[i], index);
    addBoards(task.evidence[i], index);
  }
}

void CalibrationProblem::add(ceres::CostFunction* cost, int recording, double t,
                             std::vector<NoiseKind> kinds) {
  const auto id = problem_.AddResidualBlock(cost, new ceres::CauchyLoss(kRobust), parameters_.data());
  blocks_.push_back({id, recording, t, std::move(kinds)});
}

// Short movements tell when the robot turns; long ones turn it far enough to show where on it the lidar is.
void CalibrationProblem::addWheels(const RecordingEvidence& recording, int index) {
  for (const PlanarPath& wheels : recording.wheels) {
    for (const WheelMovement& m : wheelMovements(recording, wheels, parameters_[kWheelTime], kShortWheels_s))
      add(new ceres::AutoDiffCostFunction<WheelTurnCost, 1, kParameterCount>(
              new WheelTurnCost{m, sigma(NoiseKind::kWheelTurn, turnSigma(lengthOf(m), turnOf(m)))}),
          index, m.t_b, {NoiseKind::kWheelTurn});
    for (const WheelMovement& m : wheelMovements(recording, wheels, parameters_[kWheelTime], kLongWheels_s))
      add(new ceres::AutoDiffCostFunction<WheelMoveCost, 2, kParameterCount>(new WheelMoveCost{
              m, sigma(NoiseKind::kWheelForward, forwardSigma(lengthOf(m))),
              sigma(NoiseKind::kWheelSide, sideSigma(lengthOf(m), turnOf(m)))}),
          index, m.t_b, {NoiseKind::kWheelForward, NoiseKind::kWheelSide});
  }
}

void CalibrationProblem::addViews(const RecordingEvidence& recording, int index, const MatchGate& gate) {
  for (const DepthView& view : recording.views)
    for (const DepthPatch& patch : view.floor)
      add(new ceres::AutoDiffCostFunction<FloorCost, 1, kParameterCount>(
              new FloorCost{patch, sigma(NoiseKind::kFloor, patchSigma(patch.point.z()))}),
          index, view.t, {NoiseKind::kFloor});
  for (const WallMatch& match : matchWalls(recording, parameters_, task_.lidar_z_m, gate))
    add(new ceres::AutoDiffCostFunction<WallCost, 1, kParameterCount>(
            new WallCost{&recording.lidar[match.path], match, sigma(NoiseKind::kWall, sigmaOf(match))}),
        index, match.view_t, {NoiseKind::kWall});
}

void CalibrationProblem::addSteps(const RecordingEvidence& recording, int index) {
  for (const CameraStep& step : recording.steps) {
    const double offset = parameters_[kCameraTime];
    const PlanarPath* reference = pathAt(recording.lidar, step.t_a + offset, kPathMargin_s);
    if (!reference || !reference->covers(step.t_b + offset, kPathMargin_s)) continue;
    add(new ceres::AutoDiffCostFunction<CameraStepCost, 6, kParameterCount>(
            new CameraStepCost{reference, step, offset, sigma(NoiseKind::kCameraTurn, kTurnSigma_rad),
                               sigma(NoiseKind::kCameraMove, kMoveSigma_m)}),
        index, step.t_b,
        {NoiseKind::kCameraTurn, NoiseKind::kCameraTurn, NoiseKind::kCameraTurn, NoiseKind::kCameraMove,
         NoiseKind::kCameraMove, NoiseKind::kCameraMove});
  }
}

void CalibrationProblem::addBoards(const RecordingEvidence& recording, int index) {
  for (const BoardView& view : recording.boards)
    if (view.depth)
      add(new ceres::AutoDiffCostFunction<BoardDepthCost, 1, kParameterCount>(new BoardDepthCost{
              view, sigma(NoiseKind::kBoardDepth, depthSigma(view))}),
          index, view.t, {NoiseKind::kBoardDepth});
  const double offset = parameters_[kCameraTime];
  const Eigen::Matrix3d unit = Eigen::Matrix3d::Identity();
  for (const auto& [path, a, b] : boardPairs(recording, offset)) {
    const Eigen::Matrix3d b_from_a = b->camera_from_board.linear() * a->camera_from_board.linear().transpose();
    const Eigen::Matrix3d turn =
        a->turn_covariance + b->turn_covariance + kBoardTurn_rad * kBoardTurn_rad * unit;
    const double path_m = std::hypot(kBoardPlace_m, kBoardTurn_rad * b->camera_from_board.translation().norm());
    const Eigen::Matrix3d place =
        b_from_a * a->place_covariance * b_from_a.transpose() + b->place_covariance + path_m * path_m * unit;
    add(new ceres::AutoDiffCostFunction<BoardCost, 6, kParameterCount>(
            new BoardCost{path, *a, *b, offset, rootInformation(turn, sigma(NoiseKind::kBoardTurn, 1)),
                          rootInformation(place, sigma(NoiseKind::kBoardPlace, 1))}),
        index, b->t,
        {NoiseKind::kBoardTurn, NoiseKind::kBoardTurn, NoiseKind::kBoardTurn, NoiseKind::kBoardPlace,
         NoiseKind::kBoardPlace, NoiseKind::kBoardPlace});
  }
}

void CalibrationProblem::solve() {
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_NORMAL_CHOLESKY;
  options.num_threads = 1;  // one order of summation: the same bits on every run
  options.max_num_iterations = 60;
  options.function_tolerance = 1e-9;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem_, &summary);
  if (!summary.IsSolutionUsable()) throw RunError("the calibration has no solution: " + summary.message);
}

NoiseFactors CalibrationProblem::scatter() const {
  std::array<std::vector<double>, kNoiseKinds> sizes;
  for (const Block& block : blocks_) {
    std::array<double, 6> residuals{};
    problem_.EvaluateResidualBlock(block.id, false, nullptr, residuals.data(), nullptr);
    for (std::size_t k = 0; k < block.kinds.size(); ++k)
      sizes[static_cast<std::size_t>(block.kinds[k])].push_back(std::abs(residuals[k]));
  }
  NoiseFactors out{};
  for (std::size_t k = 0; k < kNoiseKinds; ++k)
    out[k] = sizes[k].size() < kLeastResiduals ? 1 / noise_[k] : 1.4826 * median(sizes[k]);
  return out;
}

ParameterMatrix CalibrationProblem::inverseInformation() {
  ceres::Covariance::Options options;
  options.algorithm_type = ceres::DENSE_SVD;
  options.num_threads = 1;
  ceres::Covariance covariance(options);
  const std::vector<const double*> wanted{parameters_.data()};
  Eigen::Matrix<double, kParameterCount, kParameterCount, Eigen::RowMajor> out;
  if (!covariance.Compute(wanted, &problem_) || !covariance.GetCovarianceMatrix(wanted, out.data()))
    throw RunError("the covariance of the calibration cannot be computed");
  return out;
}

// The solver leaves out the columns of parameters that are held.
CalibrationProblem::Jacobian CalibrationProblem::jacobianOf(const Block& block, std::array<double, 6>& residuals) const {
  Jacobian out = Jacobian::Zero();
  const auto free = static_cast<std::size_t>(kParameterCount) - task_.held.count();
  if (free == 0) return out;
  std::vector<double> told(6 * free);
  double* rows = told.data();
  problem_.EvaluateResidualBlock(block.id, true, nullptr, residuals.data(), &rows);
  for (std::size_t row = 0; row < block.kinds.size(); ++row)
    for (std::size_t i = 0, k = 0; i < static_cast<std::size_t>(kParameterCount); ++i)
      if (!task_.held[i]) out(static_cast<Eigen::Index>(row), static_cast<Eigen::Index>(i)) = told[row * free + k++];
  return out;
}

ParameterMatrix CalibrationProblem::covariance() {
  const ParameterMatrix inverse = inverseInformation();
  struct Bin {
    ParameterVector gradient = ParameterVector::Zero();
    ParameterMatrix information = ParameterMatrix::Zero();
  };
  std::map<std::pair<int, long>, Bin> bins;
  for (const Block& block : blocks_) {
    std::array<double, 6> residuals{};
    const auto jacobian = jacobianOf(block, residuals);
    Bin& bin = bins[{block.recording, std::lround(block.t / kBin_s)}];
    bin.gradient += jacobian.transpose() * Eigen::Map<const Eigen::Matrix<double, 6, 1>>(residuals.data());
    bin.information += jacobian.transpose() * jacobian;
  }
  // The solution has come towards each bin. Times `inverse` these are its changes when a bin is left out (jackknife; Bell and
  // McCaffrey 2002).
  std::map<std::pair<int, long>, ParameterVector> gradients;
  for (const auto& [key, bin] : bins) {
    const ParameterMatrix left = ParameterMatrix::Identity() - kMostOfAll * bin.information * inverse;
    gradients[key] = left.partialPivLu().solve(bin.gradient);
  }
  ParameterMatrix scattered = ParameterMatrix::Zero();
  for (const auto& [key, gradient] : gradients)
    for (int lag = 0; lag <= kLags; ++lag) {
      const auto other = gradients.find({key.first, key.second + lag});
      if (other == gradients.end()) continue;
      const ParameterMatrix product = (1 - lag / (kLags + 1.0)) * gradient * other->second.transpose();
      scattered += lag == 0 ? product : ParameterMatrix(product + product.transpose());
    }
  ParameterMatrix out = inverse * (belief_ + scattered) * inverse;
  // Few gradients scatter too little by chance: never less than what independent errors would leave.
  ParameterVector factors = ParameterVector::Ones();
  for (int i = 0; i < kParameterCount; ++i)
    if (inverse(i, i) > 0) factors[i] = std::sqrt(std::max(1.0, inverse(i, i) / std::max(out(i, i), 1e-30)));
  return factors.asDiagonal() * out * factors.asDiagonal();
}

int CalibrationProblem::count(NoiseKind kind) const {
  int out = 0;
  for (const Block& block : blocks_) out += block.kinds.front() == kind;
  return out;
}

}  // namespace roomgraph
