// SPDX-License-Identifier: BSD-3-Clause
// DenseChain: the camera's movement since the last frame that features placed, by dense alignment.
#pragma once

#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "dense_alignment.h"

namespace roomgraph::tracking {

/// Movement since the frame that the chain began with.
struct ChainedMovement {
  bool seen = false;  ///< or only predicted
  Pose3 first_from_current = Pose3::Identity();
  Matrix6d covariance = Matrix6d::Zero();  ///< of (translation, rotation) in the first frame's axes
};

/// The robot that carries the camera, and how little it moves but ahead and about its z axis: over the square root of a second
/// (MovementHabits).
struct CarryingBody {
  Pose3 camera_from_body = Pose3::Identity();
  Vector6d scatter = Vector6d::Zero();
};

/// Aligns frames one after the other with the same reference for as long as they show enough of it, so that errors add up
/// with new references only.
class DenseChain {
 public:
  /// From now on movements are those since this frame. Its images are shared, not copied.
  /// `moving`: the velocity is known that predicted movements come from.
  void begin(const Frame& frame, const std::vector<Box2>& excluded, bool moving);
  /// What is known of a frame's movement before it is looked at.
  struct Prediction {
    /// Movement since the beginning, by the velocity before or by other sensors, which is the answer for a moment where the
    /// images do not say how the camera moved. Nothing after that: the chain is broken until it begins again.
    Pose3 first_from_current = Pose3::Identity();
    bool measured = false;  ///< by other sensors
    std::optional<Pose3> otherwise = {};  ///< where the velocity leads, should these have erred: wheels slip
    std::optional<CarryingBody> body = {};
    /// Of the last step, where it was measured, m and rad.
    double sigma_m = std::numeric_limits<double>::infinity(), sigma_rad = std::numeric_limits<double>::infinity();
  };
  std::optional<ChainedMovement> follow(const Frame& frame, const std::vector<Box2>& excluded, const Prediction& predicted);
  /// Whether all since the beginning is known, or was seen a moment before time t (s).
  bool unbroken(double t) const;
  const ChainedMovement& last() const { return last_; }

 private:
  ChainedMovement coast(double t, const std::shared_ptr<const DenseImage>& image, const Prediction& predicted);

  bool begun_ = false, broken_ = false;
  bool moving_ = false;  ///< the velocity is known
  Frame first_;  ///< becomes the reference with the first frame that is aligned with it
  std::vector<Box2> excluded_;
  std::shared_ptr<const DenseImage> reference_;
  double reference_t_ = 0, last_t_ = 0, seen_t_ = 0;
  ChainedMovement to_reference_, seen_, last_;
};

}  // namespace roomgraph::tracking
