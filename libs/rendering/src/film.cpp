// SPDX-License-Identifier: BSD-3-Clause
// The frames of a film, one after the other.
#include "roomgraph/rendering/film.h"

#include <algorithm>
#include <cmath>

#include "figure_picture.h"
#include "film_writer.h"
#include "map_history.h"
#include "picture.h"
#include "roomgraph/core/errors.h"
#include "roomgraph/evaluation/frame_files.h"

namespace roomgraph {
namespace {

constexpr double kStill_s = 1.5;     ///< that the finished map stands at the end
constexpr double kInSight_s = 0.25;  ///< that a line leads to what was measured

std::string clockNote(double seconds) {
  char text[32];
  const double tenths = std::round(10 * seconds) / 10;  // 59.97 s are a minute
  std::snprintf(text, sizeof text, ",  %d:%04.1f", static_cast<int>(tenths / 60), std::fmod(tenths, 60));
  return text;
}

/// Encoders take even sizes only.
cv::Mat cutToEven(const cv::Mat& image) {
  return image(cv::Rect(0, 0, image.cols & ~1, image.rows & ~1));
}

cv::Mat frameOf(const MapPicture& picture, const ObjectDatabase& database, const FilmOptions& options) {
  if (options.style == FigureStyle::kScreen)
    return cutToEven(renderPicture(picture, database, options.picture));
  return cutToEven(
      figurePixels(picture, database,
                   {options.style, options.picture.width, options.picture.height, options.picture.title}));
}

}  // namespace

FilmResult writeFilm(const CSemanticMap& map, const std::vector<MapSighting>& sightings,
                     const ObjectDatabase& database, const FilmOptions& options,
                     const std::filesystem::path& place, const FilmProgress& progress) {
  const auto& path = map.world_from_robot;
  if (path.size() < 2) throw RunError("the map has no trajectory: there is nothing to film");
  const double speed = options.speed > 0 ? options.speed : timeOnTheWay(path) / options.seconds;
  const auto times = frameTimes(path, std::max(speed, 1e-6) / options.fps);
  const MapHistory history(map, sightings);
  const int still = static_cast<int>(std::lround(kStill_s * options.fps));
  FilmResult result{0, static_cast<int>(times.size()) + still};
  std::unique_ptr<FrameSink> sink;
  cv::Mat frame;
  for (std::size_t i = 0; i < times.size(); ++i) {
    const CSemanticMap part = history.at(times[i]);
    MapPicture picture(part, map);
    picture.in_sight = history.inSight(times[i], kInSight_s);
    picture.note = clockNote(times[i] - path.front().t);
    frame = frameOf(picture, database, options);
    if (!sink) sink = makeFrameSink(place, options.fps, frame.size());
    sink->add(frame);
    ++result.frames;
    if (progress(static_cast<double>(result.frames) / result.asked_for)) break;
  }
  if (result.frames == static_cast<int>(times.size()))
    for (int i = 0; i < still; ++i, ++result.frames) sink->add(frame);
  sink->finish();
  result.width = frame.cols;
  result.height = frame.rows;
  return result;
}

std::vector<MapSighting> readSightings(const std::filesystem::path& associations) {
  std::vector<MapSighting> sightings;
  for (const auto& frame : readAssociations(associations)) {
    MapSighting sighting{frame.t, {}};
    for (const auto& box : frame.boxes)
      if (box.landmark >= 0) sighting.landmarks.push_back(LandmarkId{box.landmark});
    sightings.push_back(sighting);
  }
  std::stable_sort(sightings.begin(), sightings.end(),
                   [](const MapSighting& a, const MapSighting& b) { return a.t < b.t; });
  return sightings;
}

}  // namespace roomgraph
