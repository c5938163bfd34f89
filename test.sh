#!/usr/bin/env bash
# Builds roomgraph and runs all tests.
set -euo pipefail
cd "$(dirname "$0")"
# mrpt-apps: whether MRPT's own tools read our files; chromium: whether the report works in a browser; xvfb, xdotool: the
# window on a display without a screen; poppler-utils: whether other programs see in our PDFs what we drew;
# man-db, zsh, fish: whether the manual page and the completion scripts work where they are used;
# python3-torch, -numpy, -opencv, -matplotlib: the training of the detector;
# python3-rosbag and the messages: whether bags of others are read, and ours by others;
# slurm-wlm, munge: a cluster of one node for `batch --engine slurm`.
MORE_PACKAGES="mrpt-apps chromium chromium-driver xvfb xdotool poppler-utils man-db zsh fish slurm-wlm munge python3-rosbag python3-geometry-msgs python3-nav-msgs python3-sensor-msgs python3-std-msgs python3-tf2-msgs python3-visualization-msgs python3-torch python3-numpy python3-opencv python3-matplotlib" ./setup.sh
# One more than there are processors: some tests wait, for a cluster, a browser, a window.
exec ctest --test-dir build/release --output-on-failure --timeout 300 -j "$(($(nproc) + 1))"
