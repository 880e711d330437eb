#!/bin/bash
# A stack of 512 x 512 x 768 voxels (403 MB as 16 bits, 805 MB as floats) is loaded and meshed in under 120 MB.
set -euo pipefail
delvox=$1 streaming_bench=$2
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
"$delvox" phantom sphere --dims 512,512,768 --type uint16 -o "$folder/stack.tif" --quiet
"$streaming_bench" "$folder/stack.tif" --iso 32767.5 --repeat 1 --at-most 120
