#!/usr/bin/env bash
# Builds roomgraph and runs all tests.
set -euo pipefail
cd "$(dirname "$0")"
# mrpt-apps: whether MRPT's own tools read our files.
MORE_PACKAGES="mrpt-apps" ./setup.sh
exec ctest --test-dir build/release --output-on-failure --timeout 300 -j "$(nproc)"
