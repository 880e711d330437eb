#!/bin/bash
# From a fresh Debian 12 to a verified mesh: installs what is missing, builds, meshes the liver of Debian's
# libcgal-demo. Results and log are in build/demo.
set -euo pipefail
cd "$(dirname "$0")/.."
source tools/install_dependencies.sh

install_dependencies
cmake --preset release -DDELVOX_BUILD_TESTS=OFF
cmake --build --preset release -- -j"$(nproc)"

out=build/demo
mkdir -p "$out"
tar -xzf /usr/share/doc/libcgal-dev/data.tar.gz -C "$out" --strip-components=2 data/images/liver.inr.gz

build/release/tools/delvox tet "$out/liver.inr.gz" --iso 64 --smooth 0.8 \
  -o "$out/liver.vtu" -o "$out/liver.stl" -o "$out/liver.inp" --report "$out/liver.json"
echo
echo "The results are in $PWD/$out:"
ls -l "$out"
