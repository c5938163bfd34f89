// SPDX-License-Identifier: BSD-3-Clause
// `roomgraph import rtabmap`: a database of RTAB-Map into a rawlog.
#include <iostream>
#include <memory>

#include "bag_commands.h"
#include "commands.h"
#include "import_commands.h"
#include "roomgraph/imports/rtabmap_import.h"

namespace roomgraph {
namespace {

struct RtabmapArguments {
  std::filesystem::path database, rawlog;
  std::string odometry = "auto";
  std::vector<std::string> poses;
  RtabmapImportOptions options;
};

void importDatabase(const RtabmapArguments& a) {
  RtabmapImportOptions options = a.options;
  if (a.odometry != "auto")
    options.odometry = a.odometry == "planar" ? NodeOdometry::kPlanar : NodeOdometry::kNone;
  options.sensor_poses = posesOf(a.poses);
  ShareProgress progress("import", a.rawlog.string());
  const auto result = importRtabmap(a.database, a.rawlog, options, progress.function());
  progress.finish();
  tellWarnings(result.warnings);
  std::cout << "version " << result.version << ", session " << result.session << ": "
            << result.sessions.at(result.session) << " nodes\n";
  tellImport({a.rawlog, result.written, result.skipped, result.ground_truth, result.truth});
}

}  // namespace

void addImportRtabmap(CLI::App& importer) {
  auto* command =
      importer.add_subcommand("rtabmap", "Database of RTAB-Map (.db): RGB-D, 2D scans, poses of its nodes");
  auto a = std::make_shared<RtabmapArguments>();
  command->add_option("DB", a->database, "X.db of RTAB-Map 0.11.2 or later")->required();
  command->add_option("-o,--output", a->rawlog, "rawlog to write (gzip inside)")->required();
  command->add_option("--session", a->options.session,
                      "number of the session (map_id) to import (default: the one with most nodes)");
  command
      ->add_option("--odometry", a->odometry,
                   "auto: poses of the nodes where they stay on a floor; planar: x, y and yaw of them in any "
                   "case; none")
      ->check(CLI::IsMember({"auto", "planar", "none"}))
      ->capture_default_str();
  command
      ->add_option("--pose", a->poses,
                   "place of a sensor instead of the database's: RGBD=x,y,z,yaw,pitch,roll or LASER=... (m, "
                   "deg; x forward); may be repeated")
      ->allow_extra_args(false);
  command
      ->add_option("--jpeg", a->options.jpeg_quality,
                   "colour as JPEG of this quality in the rawlog (default: without further loss)")
      ->check(CLI::Range(1, 100));
  command->add_flag("--external-images", a->options.external_images,
                    "keep the images as files in X_Images/: no loss beyond that in the database");
  command->footer(
      "Examples:\n"
      "  roomgraph import rtabmap lab.db -o lab.rawlog\n"
      "  roomgraph import rtabmap house.db -o house.rawlog --session 2 --external-images\n"
      "What becomes of each column: docs/imports.md.");
  command->callback([a] { importDatabase(*a); });
}

}  // namespace roomgraph
