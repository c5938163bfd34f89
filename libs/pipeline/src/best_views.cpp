// SPDX-License-Identifier: BSD-3-Clause
// Ranking and cutting of views, and their assignment to landmarks with hindsight.
#include "roomgraph/pipeline/best_views.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "roomgraph/core/base64.h"
#include "roomgraph/observations/frame.h"

namespace roomgraph {
namespace {

constexpr double kBetter = 1.2;   // ratio of ranks from which a picture is made again
constexpr double kBorder = 0.12;  // of the box, shown around it
constexpr int kLargest_px = 320, kQuality = 85;

double rankOf(const ObjectMeasurement& measurement) {
  if (measurement.detection.carried) return 0;
  return measurement.proposal.score * std::sqrt(measurement.detection.box.area());
}

// The box with a border, as far as it lies in the image.
cv::Rect around(const Box2& box, const cv::Size& image) {
  const double du = kBorder * box.width(), dv = kBorder * box.height();
  const cv::Rect wanted(cv::Point(cvFloor(box.u_min - du), cvFloor(box.v_min - dv)),
                        cv::Point(cvCeil(box.u_max + du), cvCeil(box.v_max + dv)));
  return wanted & cv::Rect({}, image);
}

// Empty where the image has nothing there.
std::string jpegOf(const cv::Mat& image, const Box2& box) {
  const cv::Rect part = around(box, image.size());
  if (part.empty()) return {};
  cv::Mat cut = image(part);
  const double scale = static_cast<double>(kLargest_px) / std::max(cut.cols, cut.rows);
  if (scale < 1) cv::resize(cut, cut, {}, scale, scale, cv::INTER_AREA);
  std::vector<unsigned char> bytes;
  cv::imencode(".jpg", cut, bytes, {cv::IMWRITE_JPEG_QUALITY, kQuality});
  return {bytes.begin(), bytes.end()};
}

bool sameBox(const Box2& a, const Box2& b) {
  return a.u_min == b.u_min && a.v_min == b.v_min && a.u_max == b.u_max && a.v_max == b.v_max;
}

}  // namespace

void BestViews::onStep(const StepReport& report) {
  if (!report.image) return;
  const cv::Mat& image = report.image->color.empty() ? report.image->gray : report.image->color;
  if (image.empty()) return;
  for (const auto& decision : report.decisions) {
    const ObjectMeasurement& seen = decision.seen.measurement;
    View& best = best_[decision.landmark];
    const double rank = rankOf(seen);
    if (rank <= kBetter * best.rank) continue;
    std::string jpeg = jpegOf(image, seen.detection.box);
    if (!jpeg.empty()) best = {report.frame, report.t, seen.detection.box, rank, std::move(jpeg)};
  }
}

std::string BestViews::text(const ObjectFrames& frames) const {
  std::multimap<FrameId, const View*> taken;
  for (const auto& [id, view] : best_)
    if (!view.jpeg.empty()) taken.emplace(view.frame, &view);
  std::map<LandmarkId, const View*> chosen;
  const auto choose = [&](const View& view, const Box2& box, LandmarkId landmark) {
    if (!sameBox(box, view.box)) return;
    const View*& best = chosen[landmark];
    if (!best || view.rank > best->rank) best = &view;
  };
  for (const auto& frame : frames) {
    const auto [begin, end] = taken.equal_range(frame.frame);
    for (auto view = begin; view != end; ++view) {
      for (const auto& decision : frame.decisions)
        choose(*view->second, decision.seen.measurement.detection.box, decision.landmark);
    }
  }
  for (const auto& sighting : frames.former()) {
    const auto [begin, end] = taken.equal_range(sighting.frame);
    for (auto view = begin; view != end; ++view) choose(*view->second, sighting.box, sighting.landmark);
  }
  std::string out;
  for (const auto& [id, view] : chosen) {
    const Box2& box = view->box;
    out += nlohmann::ordered_json{{"id", id.value},
                                  {"timestamp", view->t},
                                  {"bbox", {box.u_min, box.v_min, box.u_max, box.v_max}},
                                  {"jpeg", toBase64(view->jpeg)}}
               .dump() +
           "\n";
  }
  return out;
}

}  // namespace roomgraph
