// SPDX-License-Identifier: BSD-3-Clause
// CARMEN logs written of rawlogs, as CARMEN's logger would have, and imports of logs.
#pragma once

#include <gtest/gtest.h>
#include <mrpt/core/Clock.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <zlib.h>

#include <cstdarg>
#include <cstdio>
#include <string>
#include <vector>

#include "rawlog_records.h"
#include "roomgraph/geometry/pose.h"
#include "roomgraph/imports/carmen_import.h"
#include "temporary_folder.h"

namespace roomgraph::test {

/// Like printf, into a string.
[[gnu::format(printf, 1, 2)]] inline std::string format(const char* pattern, ...) {
  char text[512];
  va_list arguments;
  va_start(arguments, pattern);
  std::vsnprintf(text, sizeof text, pattern, arguments);
  va_end(arguments);
  return text;
}

struct LogForm {
  bool old = false;      ///< FLASER instead of ROBOTLASER1
  bool wheels = true;    ///< lines ODOM
  double start = 1.7e9;  ///< of the logger, s
  double middle = 0;     ///< of the sweep, from the laser's axis, rad
};

/// Lines of a log with the scans and the odometry of a rawlog. Robot's poses are those of the last odometry.
inline std::string carmenLog(const std::vector<mrpt::obs::CObservation::Ptr>& records,
                             const LogForm& form = {}) {
  std::string log =
      "# CARMEN Logfile\n# file format is one message per line\nPARAM robot_length 0.5 nohost 0\n";
  Pose2 robot;
  for (const auto& record : records) {
    const double t = secondsOf(*record);
    const std::string end = format(" %.6f robot %.6f\n", t, t - form.start);
    if (const auto wheels = std::dynamic_pointer_cast<mrpt::obs::CObservationOdometry>(record)) {
      robot = {wheels->odometry.x(), wheels->odometry.y(), wheels->odometry.phi()};
      if (form.wheels)
        log += format("ODOM %.9f %.9f %.9f %.6f %.6f 0", robot.x, robot.y, robot.yaw,
                      wheels->velocityLocal.vx, wheels->velocityLocal.omega) +
               end;
    }
    const auto scan = std::dynamic_pointer_cast<mrpt::obs::CObservation2DRangeScan>(record);
    if (!scan) continue;
    const std::size_t count = scan->getScanSize();
    if (form.old)
      log += format("FLASER %zu", count);
    else
      log += format("ROBOTLASER1 0 %.9f %.9f %.9f %.6f 0.01 0 %zu", -0.5 * scan->aperture, scan->aperture,
                    scan->aperture / static_cast<double>(count - 1), scan->maxRange, count);
    for (std::size_t i = 0; i < count; ++i)
      log += format(" %.7g", scan->getScanRangeValidity(i) ? scan->getScanRange(i) : scan->maxRange);
    if (!form.old) log += " 0";
    const Pose2 laser = robot * planarPart(toPose3(scan->sensorPose)) * Pose2{0, 0, -form.middle};
    for (const Pose2& pose : {laser, robot}) log += format(" %.9f %.9f %.9f", pose.x, pose.y, pose.yaw);
    if (!form.old) log += " 0.1 0 0.5 0.5 0";
    log += end;
  }
  return log;
}

inline std::filesystem::path writeGz(const TemporaryFolder& folder, const std::string& name,
                                     const std::string& text) {
  gzFile out = gzopen(folder.file(name).c_str(), "wb");
  EXPECT_EQ(gzwrite(out, text.data(), static_cast<unsigned>(text.size())), static_cast<int>(text.size()));
  EXPECT_EQ(gzclose(out), Z_OK);
  return folder.file(name);
}

/// A log of this text, imported.
struct ImportedLog {
  explicit ImportedLog(const std::string& text, const CarmenImportOptions& options = {}) {
    result = importCarmen(folder.write("x.log", text), folder.file("x.rawlog"), options);
    records = recordsIn(folder.file("x.rawlog"));
  }
  TemporaryFolder folder;
  CarmenImportResult result;
  std::vector<mrpt::obs::CObservation::Ptr> records;
};

}  // namespace roomgraph::test
