// SPDX-License-Identifier: BSD-3-Clause
// Drawing of ground grid, boxes, masks, rejected hypotheses, decisions and status line.
#include "roomgraph/rendering/debug_picture.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "glyphs.h"
#include "roomgraph/core/errors.h"
#include "roomgraph/rendering/palette.h"
#include "wireframe.h"

namespace roomgraph {
namespace {

using palette::TColor;

const TColor kHint{120, 230, 235}, kEdge{255, 235, 60}, kRejected{170, 170, 170}, kAlarm{255, 110, 90};
constexpr double kText_px = 9;

cv::Scalar scalar(const TColor& color) {
  return {color.B * 1.0, color.G * 1.0, color.R * 1.0};
}

// Ends far outside would overflow OpenCV's fixed-point coordinates.
void line(cv::Mat& image, const Segment2& segment, const TColor& color, int thickness) {
  constexpr double kLimit_px = 1e4;
  if (!(segment.a.cwiseAbs().maxCoeff() < kLimit_px && segment.b.cwiseAbs().maxCoeff() < kLimit_px)) return;
  const auto fixed = [](const Eigen::Vector2d& p) {
    return cv::Point(static_cast<int>(std::lround(p.x() * 16)), static_cast<int>(std::lround(p.y() * 16)));
  };
  cv::line(image, fixed(segment.a), fixed(segment.b), scalar(color), thickness, cv::LINE_AA, 4);
}

void dashedLine(cv::Mat& image, const Segment2& segment, const TColor& color, int thickness) {
  const double length = (segment.b - segment.a).norm();
  const Eigen::Vector2d along = (segment.b - segment.a) / std::max(length, 1e-9);
  for (double at = 0; at < length; at += 12)
    line(image, {segment.a + at * along, segment.a + std::min(at + 6, length) * along}, color, thickness);
}

void drawBox(cv::Mat& image, const Box2& box, const TColor& color, bool dashed) {
  const Eigen::Vector2d corners[] = {{box.u_min, box.v_min},
                                     {box.u_max - 1, box.v_min},
                                     {box.u_max - 1, box.v_max - 1},
                                     {box.u_min, box.v_max - 1}};
  for (int i = 0; i < 4; ++i)
    (dashed ? dashedLine : line)(image, {corners[i], corners[(i + 1) % 4]}, color, 2);
}

void write(cv::Mat& image, const std::string& text, Eigen::Vector2d base, const TColor& color) {
  const TextStyle style{kText_px, color, 2};
  base.x() = std::clamp(base.x(), 2.0, std::max(2.0, image.cols - textWidth(text, style) - 2));
  base.y() = std::clamp(base.y(), kText_px + 3, image.rows - 4.0);
  drawText(image, text, base, style);
}

std::string number(double value) {
  char text[16];
  std::snprintf(text, sizeof text, "%.2f", value);
  return text;
}

cv::Mat background(const Frame& frame) {
  cv::Mat image;
  if (!frame.color.empty())
    image = frame.color.clone();
  else if (!frame.gray.empty())
    cv::cvtColor(frame.gray, image, cv::COLOR_GRAY2BGR);
  else if (frame.hasDepth()) {
    cv::Mat gray;
    frame.depth.convertTo(gray, CV_8UC1, 40);  // white from 6.4 m on
    cv::cvtColor(gray, image, cv::COLOR_GRAY2BGR);
  }
  return image;
}

void drawGround(cv::Mat& image, const Plane& ground, const PinholeCamera& camera) {
  cv::Mat grid = image.clone();
  for (const auto& segment : groundGrid(ground, camera)) line(grid, segment, kHint, 1);
  if (const auto vanishing = horizon(ground, camera)) dashedLine(grid, *vanishing, kHint, 1);
  cv::addWeighted(grid, 0.4, image, 0.6, 0, image);
}

void tint(cv::Vec3b& pixel, const TColor& color) {
  const int target[] = {color.B, color.G, color.R};
  for (int c = 0; c < 3; ++c) pixel[c] = static_cast<unsigned char>((pixel[c] + target[c]) / 2);
}

// The network's own mask, where it gives one.
void drawMask(cv::Mat& image, const Detection& detection, const TColor& color) {
  const int u0 = static_cast<int>(detection.box.u_min), v0 = static_cast<int>(detection.box.v_min);
  for (int v = 0; v < detection.mask.rows; ++v)
    for (int u = (v & 1); u < detection.mask.cols; u += 2)
      if (detection.mask.at<unsigned char>(v, u) && u0 + u < image.cols && v0 + v < image.rows)
        tint(image.at<cv::Vec3b>(v0 + v, u0 + u), color);
}

void drawTrace(cv::Mat& image, const ProposalTrace& trace, const PinholeCamera& camera, const TColor& color) {
  const cv::Rect inside({}, image.size());
  for (const auto& pixel : trace.mask_pixels) {
    const cv::Point at(static_cast<int>(std::lround(pixel.x())), static_cast<int>(std::lround(pixel.y())));
    if (inside.contains(at)) image.at<cv::Vec3b>(at) = cv::Vec3b(color.B, color.G, color.R);
  }
  for (const auto& segment : trace.segments) line(image, segment, kEdge, 1);
  for (const auto& proposal : trace.rejected)
    for (const auto& edge : wireframe(proposal.shape, proposal.camera_from_object, camera))
      line(image, edge, kRejected, 1);
}

void drawDecision(cv::Mat& image, const ObjectDecision& decision, const PinholeCamera& camera,
                  const TColor& color) {
  const Proposal& proposal = decision.seen.measurement.proposal;
  for (const TColor& layer : {TColor(255, 255, 255), color})
    for (const auto& edge : wireframe(proposal.shape, proposal.camera_from_object, camera))
      line(image, edge, layer, layer == color ? 2 : 4);
  const std::string name = decision.landmark.valid() ? "#" + std::to_string(decision.landmark.value) : "none";
  const Box2& box = proposal.projected.visible;
  write(image, name + (decision.association.landmark.valid() ? " " : " new ") + number(proposal.score),
        {box.center().x() - 15, box.v_max - 6}, color);
}

std::string statusOf(const StepReport& report) {
  std::string text;
  const auto add = [&](const std::string& part) { text += (text.empty() ? "" : "; ") + part; };
  if (!report.note.empty()) add(report.note);
  if (report.proposals && !report.proposals->ground)
    add("no ground: " + (report.proposals->ground_reason.empty() ? "not looked for" : report.proposals->ground_reason));
  if (report.detections.carried)
    add("boxes carried");
  else if (!report.detections.fresh)
    add("no detections");
  return text;
}

void drawStatus(cv::Mat& image, const StepReport& report) {
  char stamp[64];
  std::snprintf(stamp, sizeof stamp, "frame %lld  t %.3f", static_cast<long long>(report.frame.value),
                report.t);
  const Eigen::Vector2d base(4, image.rows - 6.0);
  write(image, stamp, base, palette::kInk);
  if (const std::string status = statusOf(report); !status.empty())
    write(image, status, base - Eigen::Vector2d(0, 2 * kText_px), kAlarm);
}

}  // namespace

cv::Mat debugPicture(const StepReport& report, const ObjectDatabase& database) {
  if (report.kind != StepReport::Kind::kFrame || !report.image || !report.image->camera.valid()) return {};
  const PinholeCamera& camera = report.image->camera;
  cv::Mat image = background(*report.image);
  if (image.empty()) return image;
  if (report.proposals && report.proposals->ground) drawGround(image, report.proposals->ground->plane, camera);
  for (const auto& detection : report.detections.boxes)
    drawMask(image, detection, palette::ofClass(database, detection.class_name));
  if (report.proposals)
    for (std::size_t i = 0; i < std::min(report.proposals->traces.size(), report.proposals->detections.size()); ++i)
      drawTrace(image, report.proposals->traces[i], camera,
                palette::ofClass(database, report.proposals->detections[i].class_name));
  for (const auto& decision : report.decisions)
    drawDecision(image, decision, camera,
                 palette::ofClass(database, decision.seen.measurement.proposal.class_name));
  for (const auto& detection : report.detections.boxes) {
    const TColor color = palette::ofClass(database, detection.class_name);
    drawBox(image, detection.box, color, detection.carried);
    write(image, detection.class_name + " " + number(detection.score),
          {detection.box.u_min + 3, detection.box.v_min - 4}, color);
  }
  drawStatus(image, report);
  return image;
}

DebugPictures::DebugPictures(const std::filesystem::path& folder, const ObjectDatabase& database)
    : folder_(folder), database_(database) {
  std::error_code error;
  std::filesystem::create_directories(folder_, error);
  if (error) throw RunError("folder of the debug pictures " + folder_.string() + ": " + error.message());
}

void DebugPictures::onStep(const StepReport& report) {
  const cv::Mat image = debugPicture(report, database_);
  if (image.empty()) return;
  char name[40];
  std::snprintf(name, sizeof name, "frame_%06lld.jpg", static_cast<long long>(report.frame.value));
  const std::string file = (folder_ / name).string();
  bool written = false;
  try {
    written = cv::imwrite(file, image, {cv::IMWRITE_JPEG_QUALITY, 88});
  } catch (const cv::Exception&) {
  }
  if (!written) throw RunError(file + ": cannot be written");
}

}  // namespace roomgraph
