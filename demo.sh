#!/usr/bin/env bash
# Builds roomgraph and replays a recording with ground truth that Debian's mrpt-common package installs: a robot with a
# 2D laser scanner in a simulated flat. Ends with the trajectory error, an occupancy map and a picture.
set -euo pipefail
cd "$(dirname "$0")"
./setup.sh --target roomgraph_app

recording=/usr/share/mrpt/datasets/graphslam-engine-demos/action_observations_map/simul.rawlog
roomgraph=build/release/bin/roomgraph
"$roomgraph" info "$recording"
"$roomgraph" run "$recording" -o out/demo
"$roomgraph" evaluate trajectory "$recording.GT.txt" out/demo/trajectory.tum --json out/demo/trajectory_error.json
echo
echo "The map as a picture:     out/demo/snapshot.png"
echo "The occupancy grid:       out/demo/map.pgm, out/demo/map.yaml"
echo "The robot's trajectory:   out/demo/trajectory.tum"
