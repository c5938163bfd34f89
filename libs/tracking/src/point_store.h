// SPDX-License-Identifier: BSD-3-Clause
// Map points of visual odometry, by id.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <deque>
#include <memory>
#include <utility>
#include <vector>

namespace roomgraph::tracking {

using Descriptor = std::array<std::uint8_t, 32>;

/// A feature of a keyframe that shows a point.
struct Sighting {
  int keyframe = -1, feature = -1;
};

/// A 3D point of the map; its id is its index, which never changes.
struct MapPoint {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< odom frame, m
  Descriptor descriptor{};
  Eigen::Vector3d direction = Eigen::Vector3d::Zero();  ///< unit, from the camera that saw it last
  double distance = 0;                                  ///< m, and the level of the pyramid, at which it was seen then
  int octave = 0;
  int visible = 0, found = 0;  ///< frames in whose view it was predicted, and those that matched it
  bool erased = false;
  std::vector<Sighting> sightings;
};

/// All points that ever were. Most are erased soon, and what they took is used for new ones: memory grows with the points that
/// there are. References hold until the next release().
class PointStore {
 public:
  /// Of points that there were; ids are lower.
  std::size_t size() const { return size_; }
  /// That of an id whose point was released is an erased one, which is not to be changed.
  MapPoint& operator[](std::size_t id) { return const_cast<MapPoint&>(std::as_const(*this)[id]); }
  const MapPoint& operator[](std::size_t id) const {
    const std::int32_t place = placeOf(id);
    return place == kReleased ? released_ : points_[static_cast<std::size_t>(place)];
  }
  /// The point of the next id.
  MapPoint& add();
  /// The point is erased, and its memory given back.
  void release(std::size_t id);
  /// Points that take memory.
  std::size_t held() const { return points_.size() - free_.size(); }

 private:
  static constexpr std::int32_t kReleased = -1;
  static constexpr std::size_t kPage = 1024;
  /// Places of as many ids in a row; none once all of them are released.
  struct Page {
    std::array<std::int32_t, kPage> places;
    std::size_t released = 0;
  };
  std::int32_t placeOf(std::size_t id) const {
    const auto& page = pages_[id / kPage];
    return page ? page->places[id % kPage] : kReleased;
  }

  std::size_t size_ = 0;
  std::vector<std::unique_ptr<Page>> pages_;
  std::deque<MapPoint> points_;
  std::vector<std::int32_t> free_;  ///< places
  MapPoint released_{.erased = true};
};

}  // namespace roomgraph::tracking
