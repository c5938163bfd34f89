// SPDX-License-Identifier: BSD-3-Clause
// Object detection by neural networks through OpenCV's dnn module.
#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "roomgraph/core/rate_clock.h"
#include "roomgraph/core/read_ahead.h"
#include "roomgraph/detection/detector.h"
#include "score_calibration.h"

namespace roomgraph {

class Network;

/// Runs one or more networks through OpenCV's dnn module, and fuses what several of them find.
class DnnDetector : public Detector {
  DEFINE_MRPT_OBJECT(DnnDetector, roomgraph)
 public:
  void declareParameters(ParameterVisitor& visitor) override;
  void setDatabase(const ObjectDatabase& database) override;
  /// Loads the networks. Throws InputError with the file and the cause.
  void prepare() override;
  /// The networks run only when their boxes of that frame are not in the result store.
  Outcome<std::vector<Detection>> detect(const Frame& frame) override;
  /// Not when every network has a rate, and the turn of none has come.
  bool due(const Frame& frame) override;
  std::vector<std::string> unsought() const override { return unsought_; }
  bool foresee(const Frame& frame) override;
  void setResultStore(ResultStore& store) override { results_ = &store; }
  DetectorIdentity identity() const override;
  bool hasModels() const { return !models_.empty(); }
  double scoreThreshold() const { return score_threshold_; }

 private:
  using Chosen = std::vector<char>;  ///< of each network, whether it runs
  Outcome<std::vector<Detection>> run(const Frame& frame);
  void mapLabels();
  static bool usable(const Frame& frame);
  Chosen dueAt(double t);
  void forgetBefore(double t);
  std::vector<std::string> unsoughtWithout(const Chosen& chosen) const;

  std::vector<std::string> models_;
  std::string labels_file_;
  std::vector<std::string> segmentation_labels_{"door"};
  int input_size_px_ = 0;
  double score_threshold_ = 0.35;
  double nms_threshold_ = 0.5;
  double twin_threshold_ = 1;

  const ObjectDatabase* database_ = nullptr;
  std::vector<std::shared_ptr<Network>> networks_;
  std::vector<std::vector<int>> classes_;  ///< of the database (index), of each network's labels; -1: none
  std::vector<ScoreCalibration> calibrations_;  ///< of each network
  std::mutex running_;                     ///< networks run on one frame at a time
  std::mutex choosing_;                    ///< of the next two
  std::vector<RateClock> clocks_;          ///< of each network
  std::map<double, Chosen> chosen_;        ///< by time of the frame, until later ones are detected in
  std::vector<std::string> unsought_;      ///< in the last frame that was detected in
  Foreseen<Outcome<std::vector<Detection>>> foreseen_;
  DetectorIdentity identity_;
  ResultStore* results_ = nullptr;
};

}  // namespace roomgraph
