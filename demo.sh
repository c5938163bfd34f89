#!/usr/bin/env bash
# Builds roomgraph and shows it at work twice, each time against ground truth:
# 1. a recording that Debian's mrpt-common package installs: a robot with a 2D laser scanner in simulated halls;
# 2. a flat of two rooms with chairs, sofas, doors and people walking, simulated here: RGB-D, laser, odometry, and the
#    boxes of a simulated detector.
set -euo pipefail
cd "$(dirname "$0")"
./setup.sh --target roomgraph_app
roomgraph=build/release/bin/roomgraph

recording=/usr/share/mrpt/datasets/graphslam-engine-demos/action_observations_map/simul.rawlog
echo "== 1. A recording of mrpt-common =="
"$roomgraph" info "$recording"
"$roomgraph" run "$recording" -o out/demo/halls
"$roomgraph" evaluate trajectory "$recording.GT.txt" out/demo/halls/trajectory.tum --json out/demo/halls/trajectory_error.json

echo
echo "== 2. A simulated flat (about two minutes) =="
"$roomgraph" simulate worlds/lab.json -o out/demo/world
"$roomgraph" run out/demo/world/lab.rawlog -o out/demo/lab
"$roomgraph" evaluate trajectory out/demo/world/groundtruth_robot.txt out/demo/lab/trajectory.tum --json out/demo/lab/trajectory_error.json
"$roomgraph" evaluate objects out/demo/world/objects.json out/demo/lab/landmarks.json --truth-boxes out/demo/world/boxes.jsonl \
  --truth-trajectory out/demo/world/groundtruth_robot.txt --trajectory out/demo/lab/trajectory.tum --json out/demo/lab/objects_error.json
"$roomgraph" evaluate map out/demo/world/map_truth.yaml out/demo/lab/map.yaml --json out/demo/lab/map_error.json
"$roomgraph" snapshot out/demo/lab/map.rgmap -o out/demo/lab/orbit.png --view orbit --objects objects.ini

cat <<END

Each run as one page:    out/demo/lab/report.html  out/demo/halls/report.html (open in a browser)
Pictures of the maps:    out/demo/halls/snapshot.png  out/demo/lab/snapshot.png  out/demo/lab/orbit.png
Objects:                 out/demo/lab/landmarks.json
Occupancy grids:         map.pgm and map.yaml beside them; trajectories: trajectory.tum
END
