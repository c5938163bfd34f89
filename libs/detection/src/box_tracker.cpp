// SPDX-License-Identifier: BSD-3-Clause
// Pyramidal Lucas-Kanade tracking with forward-backward check and depth-based fallback.
#include "roomgraph/detection/box_tracker.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>

#include "box_motion.h"

namespace roomgraph {
namespace {

const cv::Size kWindow(15, 15);
constexpr int kPyramidLevels = 3;       // follows about 60 px from frame to frame
constexpr float kBackwardError_px = 1;  // of a corner followed forward and back again
constexpr int kMostCorners = 40;
constexpr double kCornerSpacing_px = 4;
constexpr double kEnoughShare = 0.35;  // of the chosen corners are needed to follow a box
constexpr double kRefreshShare = 0.6;  // below this share new corners are chosen
constexpr double kScoreDecay = 0.97;   // per frame: a carried box is less certain
constexpr double kLeastVisibleShare = 0.2, kLeastSide_px = 6;
constexpr double kDepthAgreement = 0.12;  // relative, between expected and measured depth

std::vector<cv::Mat> pyramidOf(const Frame& frame) {
  std::vector<cv::Mat> pyramid;
  cv::buildOpticalFlowPyramid(frame.gray, pyramid, kWindow, kPyramidLevels);
  return pyramid;
}

cv::Rect pixelsOf(const Box2& box, const Frame& frame) {
  const cv::Point first(static_cast<int>(std::floor(box.u_min)), static_cast<int>(std::floor(box.v_min)));
  const cv::Point last(static_cast<int>(std::ceil(box.u_max)), static_cast<int>(std::ceil(box.v_max)));
  return cv::Rect(first, last) & cv::Rect(cv::Point(), frame.gray.size());
}

cv::Size pixels(const Box2& box) {
  return {std::max(1, static_cast<int>(std::lround(box.width()))),
          std::max(1, static_cast<int>(std::lround(box.height())))};
}

// Of a mask of `whole` what lies in `visible`, the part of it inside the image.
cv::Mat visibleMask(const cv::Mat& mask, const Box2& whole, const Box2& visible) {
  cv::Mat scaled;
  cv::resize(mask, scaled, pixels(whole), 0, 0, cv::INTER_NEAREST);
  const cv::Size size = pixels(visible);
  const int left = static_cast<int>(std::lround(visible.u_min - whole.u_min));
  const int top = static_cast<int>(std::lround(visible.v_min - whole.v_min));
  const cv::Rect part(std::min(left, scaled.cols - size.width), std::min(top, scaled.rows - size.height), size.width,
                      size.height);
  return scaled(part).clone();
}

}  // namespace

bool BoxTracker::moves(const Detection& detection) const {
  return database_->moves(detection.class_name);
}

void BoxTracker::start(const std::vector<Detection>& detections, const Frame& frame) {
  tracks_.clear();
  pyramid_.clear();
  if (frame.gray.empty()) return;
  for (const Detection& detection : detections) {
    Track track;
    track.detection = detection;
    track.mask = detection.mask;
    track.box = detection.box;
    tracks_.push_back(track);
  }
  for (Track& track : tracks_) chooseCorners(track, frame);
  pyramid_ = pyramidOf(frame);
}

// 255 where a corner may lie on the object: at its depth, and not inside a moving object's box in front of
// it.
cv::Mat BoxTracker::cornerMask(const Track& track, const Frame& frame, const cv::Rect& region) const {
  cv::Mat mask;
  if (track.depth_m > 0) {
    const double margin = 0.15 + 0.1 * track.depth_m;
    cv::inRange(frame.depth(region), track.depth_m - margin, track.depth_m + margin, mask);
    cv::dilate(mask, mask, cv::Mat::ones(5, 5, CV_8UC1));  // depth is missing along edges, where corners are
  } else {
    mask = cv::Mat(region.size(), CV_8UC1, cv::Scalar(255));
  }
  if (moves(track.detection)) return mask;
  for (const Track& other : tracks_)
    if (moves(other.detection))
      mask(((pixelsOf(other.box, frame) & region) - region.tl()) & cv::Rect(cv::Point(), region.size())) = 0;
  return mask;
}

void BoxTracker::chooseCorners(Track& track, const Frame& frame) const {
  track.anchor = track.box;
  track.anchor_points.clear();
  track.depth_m = frame.hasDepth() ? objectDepth(track.box, frame) : 0;
  const cv::Rect region = pixelsOf(track.box, frame);
  if (region.area() > 0)
    cv::goodFeaturesToTrack(frame.gray(region), track.anchor_points, kMostCorners, 0.01, kCornerSpacing_px,
                            cornerMask(track, frame, region));
  for (cv::Point2f& point : track.anchor_points)
    point += cv::Point2f(static_cast<float>(region.x), static_cast<float>(region.y));
  track.points = track.anchor_points;
  track.chosen = track.points.size();
}

// All corners of all boxes at once, box after box.
BoxTracker::Flow BoxTracker::follow(const std::vector<cv::Mat>& pyramid) const {
  std::vector<cv::Point2f> from, back;
  for (const Track& track : tracks_) from.insert(from.end(), track.points.begin(), track.points.end());
  Flow flow;
  flow.good.assign(from.size(), 0);
  if (from.empty()) return flow;
  std::vector<unsigned char> there, again;
  std::vector<float> errors;
  cv::calcOpticalFlowPyrLK(pyramid_, pyramid, from, flow.points, there, errors, kWindow, kPyramidLevels);
  cv::calcOpticalFlowPyrLK(pyramid, pyramid_, flow.points, back, again, errors, kWindow, kPyramidLevels);
  const cv::Rect2f image(cv::Point2f(), cv::Size2f(pyramid[0].size()));
  for (std::size_t i = 0; i < from.size(); ++i)
    flow.good[i] = there[i] && again[i] && image.contains(flow.points[i]) &&
                   cv::norm(back[i] - from[i]) < kBackwardError_px;
  return flow;
}

bool BoxTracker::moveByCorners(Track& track, const Flow& flow, std::size_t first) const {
  std::vector<cv::Point2f> then, now;
  for (std::size_t i = 0; i < track.points.size(); ++i) {
    if (!flow.good[first + i]) continue;
    then.push_back(track.anchor_points[i]);
    now.push_back(flow.points[first + i]);
  }
  const auto motion = fitMotion(then, now, track.box.diagonal());
  const double needed = kEnoughShare * static_cast<double>(track.chosen);
  if (!motion || static_cast<double>(motion->inliers.size()) < needed) return false;
  track.anchor_points.clear();
  track.points.clear();
  for (const std::size_t i : motion->inliers) {
    track.anchor_points.push_back(then[i]);
    track.points.push_back(now[i]);
  }
  track.box = motion->apply(track.anchor);
  return true;
}

bool BoxTracker::moveByCamera(Track& track, const Frame& frame,
                              const std::optional<Pose3>& previous_from_current) const {
  if (!previous_from_current || moves(track.detection) || track.depth_m <= 0) return false;
  const auto moved =
      carriedByCamera(track.box, track.depth_m, frame.camera, previous_from_current->inverse());
  if (!moved) return false;
  const double measured = objectDepth(moved->box, frame);
  if (std::abs(measured - moved->depth_m) > kDepthAgreement * moved->depth_m) return false;
  track.box = moved->box;
  track.points.clear();  // new corners from here on
  return true;
}

// Writes the new box into the detection; false when too little of it is left in the image.
bool BoxTracker::settle(Track& track, const Frame& frame) const {
  track.box = stayingCut(track.box, track.detection.box, frame.camera.width, frame.camera.height);
  const Box2 visible = clipped(track.box, frame.camera.width, frame.camera.height);
  if (visible.width() < kLeastSide_px || visible.height() < kLeastSide_px ||
      visible.area() < kLeastVisibleShare * track.box.area())
    return false;
  track.detection.box = visible;
  track.detection.score *= kScoreDecay;
  track.detection.rival_score *= kScoreDecay;
  track.detection.carried = true;
  if (!track.mask.empty()) track.detection.mask = visibleMask(track.mask, track.box, visible);
  if (static_cast<double>(track.points.size()) < kRefreshShare * static_cast<double>(track.chosen))
    chooseCorners(track, frame);
  else if (frame.hasDepth())
    if (const double depth_m = objectDepth(track.box, frame); depth_m > 0) track.depth_m = depth_m;
  return true;
}

std::optional<std::vector<Detection>> BoxTracker::advance(const Frame& frame,
                                                          const std::optional<Pose3>& previous_from_current) {
  if (pyramid_.empty() || frame.gray.empty() || frame.gray.size() != pyramid_[0].size()) {
    tracks_.clear();
    pyramid_.clear();
    return std::nullopt;
  }
  std::vector<cv::Mat> pyramid = pyramidOf(frame);
  const Flow flow = follow(pyramid);
  std::vector<char> moved;
  std::size_t first = 0;
  for (Track& track : tracks_) {
    const std::size_t count = track.points.size();
    moved.push_back(moveByCorners(track, flow, first) || moveByCamera(track, frame, previous_from_current));
    first += count;
  }
  std::vector<Track> kept;
  for (std::size_t i = 0; i < tracks_.size(); ++i)
    if (moved[i] && settle(tracks_[i], frame)) kept.push_back(tracks_[i]);
  tracks_ = std::move(kept);
  pyramid_ = std::move(pyramid);
  std::vector<Detection> carried;
  for (const Track& track : tracks_) carried.push_back(track.detection);
  return carried;
}

}  // namespace roomgraph
