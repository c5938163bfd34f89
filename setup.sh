#!/usr/bin/env bash
# Installs the Debian packages that roomgraph needs, and those in $MORE_PACKAGES (as root or through sudo), and builds it.
# Used by demo.sh and test.sh.
set -euo pipefail
cd "$(dirname "$0")"

packages=(
  build-essential cmake ninja-build ccache git python3
  libmrpt-dev mrpt-common libceres-dev libsuitesparse-dev libopencv-dev libtbb-dev libeigen3-dev zlib1g-dev libjpeg-dev libyaml-cpp-dev
  libcli11-dev nlohmann-json3-dev libnanoflann-dev libgtest-dev libgmock-dev libbenchmark-dev
  libcurl4-openssl-dev libssl-dev libsqlite3-dev liblz4-dev libzstd-dev libbz2-dev libegl1 libgl1-mesa-dri libmrpt-gui-dev libmrpt-graphslam-dev libgl-dev libcairo2-dev pkg-config
  ${MORE_PACKAGES:-}
)
missing=()
for package in "${packages[@]}"; do
  dpkg-query -W -f '${Status}' "$package" 2>/dev/null | grep -q 'install ok installed' || missing+=("$package")
done
if ((${#missing[@]})); then
  echo "installing: ${missing[*]}"
  sudo=""
  [ "$(id -u)" = 0 ] || sudo="sudo"
  $sudo apt-get update -qq
  $sudo env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "${missing[@]}" >/dev/null
fi

[ -f build/release/build.ninja ] || cmake --preset release
cmake --build --preset release "$@"
