#!/bin/bash
# The floors of the house (design, section 2), checked on the include lines: layering.sh SOURCE_FOLDER
# Prints every breach; fails if there is one.
set -uo pipefail
cd "$1"
breaches=0

breach() {
  echo "$*"
  breaches=$((breaches + 1))
}

# only_in WHAT PATTERN ALLOWED: files of include, src and tools that include a header matching PATTERN must match ALLOWED.
only_in() {
  local what=$1 pattern=$2 allowed=$3 file
  while read -r file; do
    [ -n "$file" ] || continue
    [[ $file =~ $allowed ]] || breach "$file: $what may be included only in $allowed"
  done < <(grep -rlE "^[[:space:]]*#[[:space:]]*include[[:space:]]*[<\"]($pattern)" include src tools)
}

only_in OpenVDB 'openvdb/|volume/volume_impl\.h' '^src/volume/|^src/oracle/(isosurface|segmentation|brick)[a-z_]*\.(h|cpp)$'
only_in CGAL 'CGAL/|gmp' '^src/delaunay/|^src/oracle/(polygon|samples)[a-z_]*\.(h|cpp)$'
only_in GiNaC 'ginac/|cln/' '^src/oracle/formula_algebra\.cpp$'
only_in libtiff 'tiff' '^src/volume/[a-z_]*tiff[a-z_]*\.(h|cpp)$'
only_in HDF5 'hdf5\.h' '^src/mesh_io/hdf5_image\.cpp$'
only_in JSON 'nlohmann/' '^tools/|^src/volume/raw_json\.cpp$'
only_in CLI11 'CLI/' '^tools/'

# No engine's name in a public header, not even forward-declared.
while read -r line; do
  [ -n "$line" ] && breach "$line: a public header names an engine"
done < <(grep -rnE '\b(openvdb|CGAL|nlohmann|TIFF|tbb|GiNaC|cln)::|\bnamespace (openvdb|CGAL|nlohmann|tbb|GiNaC|cln)\b' include)

# floor ROOM: its height; rooms on one floor do not see each other.
floor() {
  case $1 in
    core) echo 0 ;;
    volume | mesh_io) echo 1 ;;
    oracle) echo 2 ;;
    delaunay | check) echo 3 ;;
    meshing) echo 4 ;;
    tools) echo 5 ;;
    *) echo unknown ;;
  esac
}

# room_of PATH: the room that a source file or an included header belongs to.
room_of() {
  local path=${1#include/delvox/}
  path=${path#delvox/}
  path=${path#src/}
  echo "${path%%/*}"
}

while IFS=: read -r file header; do
  here=$(room_of "$file") there=$(room_of "$header")
  [[ $header == */* ]] || there=$here  # a header of its own folder
  [ "$here" = "$there" ] && continue
  below=$(floor "$there") above=$(floor "$here")
  [ "$below" = unknown ] && { breach "$file: includes \"$header\", of no known room"; continue; }
  [ "$above" = unknown ] && { breach "$file: lies in no known room"; continue; }
  [ "$below" -lt "$above" ] || breach "$file: $here must not see $there (\"$header\")"
done < <(grep -rnoE '^[[:space:]]*#[[:space:]]*include[[:space:]]*"[^"]+"' include src tools --include='*.h' --include='*.cpp' |
  sed -E 's/^([^:]+):[0-9]+:.*"([^"]+)"/\1:\2/')

# Public headers see public headers only.
while read -r line; do
  [ -n "$line" ] && breach "$line: a public header includes a private one"
done < <(grep -rnE '#[[:space:]]*include[[:space:]]*"' include | grep -v '"delvox/')

if [ "$breaches" -gt 0 ]; then
  echo "$breaches breaches"
  exit 1
fi
echo "every file keeps to its floor"
