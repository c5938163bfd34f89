// SPDX-License-Identifier: BSD-3-Clause
// Key views of a map: made from frames, kept few, and found again by their corners.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "roomgraph/geometry/box.h"
#include "roomgraph/observations/frame.h"
#include "roomgraph/observations/key_view.h"

namespace roomgraph {

/// ORB corners with depth of a frame, spread over the image, at most `most_corners`; none without depth.
/// Image regions in `excluded` (px: people) are left out. The pose is left at identity.
KeyView makeKeyView(const Frame& frame, const std::vector<Box2>& excluded, int most_corners);

/// Views of which no two look from nearly one place in nearly one direction; of two such the later one in the
/// list is kept. "Nearly" starts at `apart_m` or `apart_rad` (their shares add up) and grows until at most
/// `most` views are left. By time.
std::vector<KeyView> thinnedViews(std::vector<KeyView> views, std::size_t most, double apart_m,
                                  double apart_rad);

/// Where a camera is, as the corners of one view tell.
struct ViewMatch {
  Pose3 world_from_camera = Pose3::Identity();
  int inliers = 0;
  std::size_t view = 0;  ///< index
};

/// The views of a map, in which frames are looked for.
class ViewLocator {
 public:
  explicit ViewLocator(std::vector<KeyView> views);
  ~ViewLocator();

  bool empty() const;
  /// The pose of the camera by the view with the most inliers: descriptors of every view against those of the
  /// frame, then PnP with RANSAC for the most promising ones. Nothing when fewer than 20 corners agree, or
  /// when another view, with a clearly different pose, has more than half as many.
  std::optional<ViewMatch> locate(const Frame& frame, const std::vector<Box2>& excluded) const;

 private:
  struct Views;
  std::unique_ptr<Views> views_;
};

}  // namespace roomgraph
