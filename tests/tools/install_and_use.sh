#!/bin/bash
# Installs a build and lets a project of its own find, link and run it: install_and_use.sh BUILD CONSUMER SCRATCH
set -euo pipefail
build=$1 consumer=$2 scratch=$3

rm -rf "$scratch"
mkdir -p "$scratch"
cmake --install "$build" --prefix "$scratch/prefix" >/dev/null

headers=$(cd "$scratch/prefix/include" && find . -type f | sort)
expected=$(cd "$consumer/../../../include" && find . -type f -name '*.h' | sort)
[ "$headers" = "$expected" ] || { echo "installed headers are not those of include/:"; echo "$headers"; exit 1; }

cmake -S "$consumer" -B "$scratch/build" -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_PREFIX_PATH="$scratch/prefix"
cmake --build "$scratch/build"
cd "$scratch"
./build/consumer
[ -s sphere.vtu ] || { echo "the consumer wrote no mesh"; exit 1; }
prefix/bin/delvox check sphere.vtu
