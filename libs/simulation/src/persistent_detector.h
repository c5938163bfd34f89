// SPDX-License-Identifier: BSD-3-Clause
// Simulated detector whose errors belong to object and view and change slowly, as those of networks do.
#pragma once

#include <array>
#include <map>
#include <string>
#include <vector>

#include "id_raster.h"
#include "roomgraph/core/random.h"
#include "roomgraph/observations/CObservationDetections.h"
#include "roomgraph/simulation/world.h"
#include "scene.h"

namespace roomgraph {

/// A label that a detector may give to a kind of object.
struct LabelChance {
  std::string label;
  double probability = 0;  ///< of giving it when the object is seen well
  bool own = false;        ///< the right label: its probability and score are those of detections
};

/// Labels (COCO, door and cabinet of ADE20K) for an object of this class and kind; empty: none ever.
const std::vector<LabelChance>& labelChances(const std::string& class_name, const std::string& kind);

/// From where an object is seen.
struct ViewPoint {
  double azimuth_rad = 0;  ///< of the camera in the object's frame
  double log_range = 0;    ///< natural logarithm of the distance in m
};

/// One error of one object. Over objects and views it is about standard normal; most of it is a smooth function of the
/// view, so that the same view errs the same way, and a part forgets with a time constant.
class SlowError {
 public:
  /// `own` draws what never changes.
  explicit SlowError(Random own);
  /// The value now; calls must not go back in time. `fresh` draws what is new since the last call.
  double at(const ViewPoint& view, double seconds, double memory_s, Random& fresh);

 private:
  static constexpr int kWaves = 6;
  struct Wave {
    double turns, depth, phase;
  };
  double offset_ = 0, changing_ = 0, last_s_ = 0;
  bool seen_ = false;
  std::array<Wave, kWaves> waves_{};
};

/// Detector model with memory; frames must come in order of time. The same seed gives the same boxes.
class PersistentDetector {
 public:
  /// `scene` must outlive it.
  PersistentDetector(const Scene& scene, const PinholeCamera& camera, const DetectionsSpec& spec, std::uint64_t seed);
  /// Boxes with labels for one frame; `exact` is what the camera sees, `index` the frame's number.
  CObservationDetections detect(const IdImage& exact, const Pose3& world_from_camera, double seconds, int index);

 private:
  /// A place of the background that is taken for an object when seen as it was at first.
  struct Phantom {
    Eigen::Vector3d at, direction;  ///< world; direction from the camera, unit
    double range_m, width_m, height_m;
    std::string label;
  };
  double error(int object, int purpose, const ViewPoint& view, double seconds, Random& fresh);
  void detectObject(const ObjectView& seen, const ViewPoint& view, double seconds, Random& fresh,
                    CObservationDetections& out);
  void detectPhantoms(const IdImage& exact, const Pose3& world_from_camera, double seconds, Random& fresh,
                      CObservationDetections& out);
  void maybeNewPhantom(const IdImage& exact, const Pose3& world_from_camera, Random& fresh);

  const Scene& scene_;
  PinholeCamera camera_;
  DetectionsSpec spec_;
  std::uint64_t seed_;
  std::map<std::pair<int, int>, SlowError> errors_;  ///< by object (phantoms: below 0) and purpose
  std::vector<Phantom> phantoms_;
};

}  // namespace roomgraph
