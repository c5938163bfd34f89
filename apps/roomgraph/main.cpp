// SPDX-License-Identifier: BSD-3-Clause
// Part of roomgraph, object-level semantic SLAM.
#include <iostream>

#include "commands.h"
#include "roomgraph/core/errors.h"
#include "roomgraph/observations/register_classes.h"

int main(int argc, char** argv) {
  CLI::App app{"Object-level semantic SLAM on MRPT rawlogs (RGB-D, 2D lidar, odometry).", "roomgraph"};
  app.set_version_flag("--version", ROOMGRAPH_VERSION);
  app.require_subcommand(1);
  app.footer("Exit codes: 0 done, 1 the run failed, 2 wrong usage or config, 3 input cannot be read.");
  roomgraph::observations::registerClasses();
  roomgraph::addImportCommand(app);
  roomgraph::addInfoCommand(app);

  roomgraph::addRunCommand(app);
  roomgraph::addEvaluateCommand(app);
  roomgraph::addSnapshotCommand(app);
  roomgraph::addSimulateCommand(app);

  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  } catch (const roomgraph::Error& error) {
    std::cerr << "roomgraph: " << error.what() << "\n";
    return error.exit_code;
  } catch (const std::exception& error) {
    std::cerr << "roomgraph: internal error: " << error.what() << "\n";
    return 1;
  }
  return 0;
}
