// SPDX-License-Identifier: BSD-3-Clause
// Labels, decimals and sense of the usual figures of an evaluation.
#include "roomgraph/catalogue/figure_list.h"

namespace roomgraph {

const std::vector<ShownFigure>& shownFigures() {
  static const std::vector<ShownFigure> figures{
      {"trajectory.ate_rmse_m", "ATE, m", 3, -1},
      {"trajectory.rpe_trans_rmse_m", "RPE, m/s", 3, -1},
      {"trajectory.rpe_rot_rmse_deg", "RPE, deg/s", 2, -1},
      {"trajectory.coverage", "share of the time with a pose", 2, 1},
      {"relations.trans_abs_mean_m", "relations: translation, m", 4, -1},
      {"relations.rot_abs_mean_deg", "relations: rotation, deg", 3, -1},
      {"objects.precision", "objects: precision", 3, 1},
      {"objects.recall", "objects: recall", 3, 1},
      {"objects.f1", "objects: F1", 3, 1},
      {"objects.duplicates", "objects: duplicates", 0, -1},
      {"objects.position_error_mean_m", "objects: centre error, m", 3, -1},
      {"objects.yaw_error_mean_deg", "objects: yaw error, deg", 1, -1},
      {"objects.size_error_mean_m", "objects: size error, m", 3, -1},
      {"objects.iou3d_mean", "objects: 3D IoU", 3, 1},
      {"objects.association_accuracy", "association: accuracy", 3, 1},
      {"objects.association_ece", "association: calibration error", 3, -1},
      {"objects.identity_switches", "association: identity switches", 0, -1},
      {"detections.precision", "detections: precision", 3, 1},
      {"detections.recall", "detections: recall", 3, 1},
      {"detections.ap", "detections: mean AP", 3, 1},
      {"map.f1", "map: F1 of occupied", 3, 1},
      {"map.free_agreement", "map: free agreement", 3, 1},
      {"map.unknown_share", "map: unknown share", 3, -1},
      {"map.wall_distance_mean_m", "map: wall distance, mean m", 3, -1},
      {"map.wall_distance_p95_m", "map: wall distance, 95 % m", 3, -1},
      {"counts.landmarks", "objects in the map", 0, 0},
      {"counts.loop_closures", "loop closures", 0, 0},
      {"run.wall_s", "time of the run, s", 1, -1},
      {"run.peak_memory_mb", "peak memory, MB", 0, -1},
  };
  return figures;
}

ShownFigure shownFigure(const std::string& name) {
  for (const auto& figure : shownFigures())
    if (figure.name == name) return figure;
  return {name, name};
}

}  // namespace roomgraph
