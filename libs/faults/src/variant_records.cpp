// SPDX-License-Identifier: BSD-3-Clause
// Beams left out; mirrored scans, images, boxes and wheels; reversed velocities.
#include "variant_records.h"

#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/obs/CObservationComment.h>
#include <mrpt/obs/CObservationOdometry.h>

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>

#include "roomgraph/observations/detection_comment.h"

namespace roomgraph {
namespace {

using namespace mrpt::obs;

void mirrorSensorPose(CObservation& observation) {
  mrpt::poses::CPose3D pose;
  observation.getSensorPose(pose);
  observation.setSensorPose(toMrpt(mirrored(toPose3(pose))));
}

template <class Matrix>
void mirrorColumns(Matrix& image) {
  const Matrix before = image;
  for (int v = 0; v < before.rows(); ++v)
    for (int u = 0; u < before.cols(); ++u) image(v, u) = before(v, before.cols() - 1 - u);
}

void mirrorCamera(mrpt::img::TCamera& camera) {
  camera.cx(camera.ncols - 1.0 - camera.cx());
  if (camera.distortion == mrpt::img::DistortionModel::kannala_brandt) return;
  constexpr int kSidewaysTangential = 3;  // p2 of k1, k2, p1, p2, k3 ...
  camera.dist[kSidewaysTangential] = -camera.dist[kSidewaysTangential];
}

void mirrorImages(CObservation3DRangeScan& images) {
  mirrorSensorPose(images);
  if (images.hasRangeImage) mirrorColumns(images.rangeImage);
  for (auto& [name, layer] : images.rangeImageOtherLayers) mirrorColumns(layer);
  if (images.hasIntensityImage && !images.intensityImage.isEmpty()) {
    cv::Mat flipped;
    cv::flip(images.intensityImage.asCvMat<cv::Mat>(mrpt::img::SHALLOW_COPY), flipped, 1);
    images.intensityImage = mrpt::img::CImage(flipped, mrpt::img::SHALLOW_COPY);
  }
  mirrorCamera(images.cameraParams);
  mirrorCamera(images.cameraParamsIntensity);
  images.relativePoseIntensityWRTDepth = toMrpt(mirroredOptical(toPose3(images.relativePoseIntensityWRTDepth)));
  // What these hold is in the depth image, too.
  images.hasPoints3D = false;
  images.resizePoints3DVectors(0);
  images.hasConfidenceImage = false;
  images.confidenceImage = {};
  images.pixelLabels.reset();
}

CObservationDetections mirroredBoxes(CObservationDetections detections) {
  for (auto& item : detections.items) {
    const double width = detections.image_width, u_min = item.u_min;
    item.u_min = width - item.u_max;
    item.u_max = width - u_min;
    if (cv::Mat mask = toMask(item.mask); !mask.empty()) {
      cv::flip(mask, mask, 1);
      item.mask = toRuns(mask);
    }
  }
  return detections;
}

void mirrorOdometry(CObservationOdometry& reading) {
  const auto& pose = reading.odometry;
  reading.odometry = {pose.x(), -pose.y(), -pose.phi()};
  reading.velocityLocal.vy = -reading.velocityLocal.vy;
  reading.velocityLocal.omega = -reading.velocityLocal.omega;
  reading.hasEncodersInfo = false;
}

}  // namespace

Pose3 mirrored(const Pose3& pose) {
  const Eigen::DiagonalMatrix<double, 4> sides(1, -1, 1, 1);
  Pose3 out;
  out.matrix() = sides * pose.matrix() * sides;
  return out;
}

Pose3 mirroredOptical(const Pose3& pose) {
  const Eigen::DiagonalMatrix<double, 4> sides(1, -1, 1, 1), optical(-1, 1, 1, 1);
  Pose3 out;
  out.matrix() = sides * pose.matrix() * optical;
  return out;
}

void thinBeams(CObservation2DRangeScan& scan, const VariantOptions& options) {
  constexpr double kSameAngle_rad = 1e-9;
  const auto beams = scan.getScanSize();
  const auto every = static_cast<std::size_t>(options.every_beam);
  const double step = beams > 1 ? static_cast<double>(scan.aperture) / static_cast<double>(beams - 1) : 0;
  std::vector<std::pair<float, bool>> kept;
  double first = 0, last = 0;  // rad, in the order of the beams, about the middle
  for (std::size_t i = beams ? (beams - 1) % every / 2 : 0; i < beams; i += every) {
    const double angle = (static_cast<double>(i) - 0.5 * static_cast<double>(beams - 1)) * step;
    if (std::abs(angle) > 0.5 * options.field_of_view_rad + kSameAngle_rad) continue;
    const float range = scan.getScanRange(i);
    const bool far = static_cast<double>(range) > options.farthest_m;
    if (kept.empty()) first = angle;
    last = angle;
    kept.emplace_back(range, scan.getScanRangeValidity(i) && !far);
  }
  const double middle = 0.5 * (first + last);
  if (std::abs(middle) > kSameAngle_rad)
    scan.sensorPose = scan.sensorPose + mrpt::poses::CPose3D(0, 0, 0, scan.rightToLeft ? middle : -middle, 0, 0);
  scan.aperture = static_cast<float>(last - first);
  scan.resizeScan(kept.size());
  for (std::size_t i = 0; i < kept.size(); ++i) {
    scan.setScanRange(i, kept[i].first);
    scan.setScanRangeValidity(i, kept[i].second);
  }
  scan.maxRange = std::min(scan.maxRange, static_cast<float>(options.farthest_m));
}

bool mirror(CObservation::Ptr& observation) {
  if (auto* scan = dynamic_cast<CObservation2DRangeScan*>(observation.get())) {
    mirrorSensorPose(*scan);
    scan->rightToLeft = !scan->rightToLeft;
  } else if (auto* images = dynamic_cast<CObservation3DRangeScan*>(observation.get())) {
    mirrorImages(*images);
  } else if (auto* reading = dynamic_cast<CObservationOdometry*>(observation.get())) {
    mirrorOdometry(*reading);
  } else {
    const auto read = unpacked(observation);
    const auto* boxes = read ? dynamic_cast<const CObservationDetections*>(read->get()) : nullptr;
    if (!boxes) return false;
    observation = std::make_shared<CObservationComment>(toComment(mirroredBoxes(*boxes)));
  }
  return true;
}

void reverseMotion(CObservation& observation) {
  auto* reading = dynamic_cast<CObservationOdometry*>(&observation);
  if (!reading) return;
  auto& velocity = reading->velocityLocal;
  velocity = {-velocity.vx, -velocity.vy, -velocity.omega};
  reading->hasEncodersInfo = false;
}

}  // namespace roomgraph
