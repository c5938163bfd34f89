#!/bin/sh
# Unpacks the models that lab_meshes.json names from the Debian package sweethome3d-furniture (apt-get install
# sweethome3d-furniture; or `dpkg-deb -x` it and give the folder of its .sh3f files) into worlds/meshes.
# Licences: CC0 and CC BY 3.0, see LICENSE.TXT in each library and /usr/share/doc/sweethome3d-furniture.
set -e
libraries=${1:-/usr/share/sweethome3d/furniture}
target=$(dirname "$0")/meshes
mkdir -p "$target"
for library in KatorLegaz BlendSwap-CC-0 BlendSwap-CC-BY Scopia Reallusion; do
  python3 -m zipfile -e "$libraries/$library.sh3f" "$target"
done
