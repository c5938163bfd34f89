#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# Renders views on all cores but one, and trains on what is there meanwhile.
#   training/render_and_train.sh DATA OUT MINUTES [further arguments of train.py, as in: --device cuda --batch 128]
# Each core draws flats of its own: 30000 to 30199, 30200 to 30399, ... VIEWS (90) views are tried of each.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
program=${ROOMGRAPH:-$here/../build/release/bin/roomgraph} views=${VIEWS:-90} cores=${CORES:-$(($(nproc) - 1))}
data=$1 out=$2 minutes=$3
shift 3
mkdir -p "$data"

render() {
  for i in $(seq 0 199); do
    flat=$((30000 + $1 * 200 + i))
    [ -e "$data/$flat/set.json" ] || LP_NUM_THREADS=0 nice -n 5 "$program" training-set -o "$data/$flat" --flats $flat-$flat --views "$views" \
      --meshes "$here/../worlds/meshes" --choice "$here/meshes.json" --quiet > /dev/null 2>> "$data/errors.txt" || true
  done
}

pids=
trap 'for pid in $pids; do pkill -P $pid; kill $pid; done 2> /dev/null || true' EXIT
trap 'exit 130' INT TERM
for core in $(seq 0 $((${cores} > 0 ? cores - 1 : 0))); do
  render "$core" &
  pids="$pids $!"
done
until ls "$data"/*/set.json > /dev/null 2>&1; do sleep 1; done
"${PYTHON:-/usr/bin/python3}" "$here/train.py" --views "$data/*" --out "$out" --minutes "$minutes" "$@"
