// SPDX-License-Identifier: BSD-3-Clause
// MRPT observation class for the boxes of a 2D object detector.
#pragma once

#include <mrpt/obs/CObservation.h>
#include <mrpt/opengl/Visualizable.h>

#include <string>
#include <vector>

#include "roomgraph/observations/mask_runs.h"

namespace roomgraph {

#pragma GCC diagnostic push
// MRPT's Visualizable has no virtual destructor; nobody owns an observation by a pointer to it.
#pragma GCC diagnostic ignored "-Wnon-virtual-dtor"

/// Boxes of a 2D object detector for one image, as a record of a rawlog. Refers to the image by time stamp
/// and label. Programs of MRPT describe it, draw it (RawLogViewer) and export it as text (rawlog-edit
/// --export-txt).
class CObservationDetections : public mrpt::obs::CObservation, public mrpt::opengl::Visualizable {
  DEFINE_SERIALIZABLE(CObservationDetections, roomgraph)
 public:
  struct Item {
    std::string label;
    double score = 0;
    double u_min = 0, v_min = 0, u_max = 0, v_max = 0;  ///< px
    std::int64_t track = -1;                            ///< id given by the source, -1: none
    MaskRuns mask{};                                    ///< over the box, or empty
  };
  std::string image_label;  ///< sensorLabel of the camera
  std::uint32_t image_width = 0, image_height = 0;
  std::string model;       ///< network, or simulator, that made the boxes
  std::string model_hash;  ///< of the weights files and of what calibrates their scores; empty when there is none
  float score_threshold = 0, nms_threshold = 0;
  std::vector<Item> items;
  /// Classes that no network looked for in this image, as theirs runs on fewer of them: that none is here says nothing.
  std::vector<std::string> unsought;

  void getSensorPose(mrpt::poses::CPose3D& out) const override { out = sensor_pose_; }
  void setSensorPose(const mrpt::poses::CPose3D& pose) override { sensor_pose_ = pose; }
  void getDescriptionAsText(std::ostream& out) const override;

  /// The image's frame and the boxes with label and score, each label in a colour of its own: u along
  /// x, v against z, the image's middle in the origin, 10 m wide.
  void getVisualizationInto(mrpt::opengl::CSetOfObjects& out) const override;

  bool exportTxtSupported() const override { return true; }
  std::string exportTxtHeader() const override;
  /// Number of boxes, then label (without blanks), score and the four sides of each, px.
  std::string exportTxtDataRow() const override;

 private:
  mrpt::poses::CPose3D sensor_pose_;
};

#pragma GCC diagnostic pop

}  // namespace roomgraph
