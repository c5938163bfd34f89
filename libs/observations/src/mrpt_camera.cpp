// SPDX-License-Identifier: BSD-3-Clause
// Fields of the two camera types, copied.
#include "roomgraph/observations/mrpt_camera.h"

namespace roomgraph {

mrpt::img::TCamera toMrpt(const PinholeCamera& camera) {
  mrpt::img::TCamera out;
  out.ncols = static_cast<std::uint32_t>(camera.width);
  out.nrows = static_cast<std::uint32_t>(camera.height);
  out.setIntrinsicParamsFromValues(camera.fx, camera.fy, camera.cx, camera.cy);
  const auto& d = camera.distortion;
  if (d != std::array<double, 5>{}) out.setDistortionPlumbBob(d[0], d[1], d[2], d[3], d[4]);
  return out;
}

PinholeCamera toPinhole(const mrpt::img::TCamera& camera) {
  return {static_cast<int>(camera.ncols),
          static_cast<int>(camera.nrows),
          camera.fx(),
          camera.fy(),
          camera.cx(),
          camera.cy(),
          {camera.k1(), camera.k2(), camera.p1(), camera.p2(), camera.k3()}};
}

Distortion distortionOf(const PinholeCamera& camera) {
  return {"plumb_bob", {camera.distortion.begin(), camera.distortion.end()}};
}

Distortion distortionOf(const mrpt::img::TCamera& camera) {
  if (camera.distortion == mrpt::img::DistortionModel::kannala_brandt)
    return {"equidistant", {camera.k1(), camera.k2(), camera.k3(), camera.k4()}};
  Distortion out = distortionOf(toPinhole(camera));
  if (camera.k4() != 0 || camera.k5() != 0 || camera.k6() != 0) {
    out.model = "rational_polynomial";
    out.coefficients.insert(out.coefficients.end(), {camera.k4(), camera.k5(), camera.k6()});
  }
  return out;
}

}  // namespace roomgraph
