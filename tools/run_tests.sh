#!/bin/bash
# Builds delvox and runs its tests. Needs Debian 12 or a system like it; installs the packages that are missing.
#   tools/run_tests.sh          the default run: unit tests, phantoms, Debian's sample volumes
#   tools/run_tests.sh --all    also scans (folder DELVOX_SCANS), heavy, solvers, and fuzz in a build with sanitizers
set -euo pipefail
cd "$(dirname "$0")/.."
source tools/install_dependencies.sh

everything=false
case "${1:-}" in
  "") ;;
  --all) everything=true ;;
  *) echo "usage: tools/run_tests.sh [--all]" >&2; exit 2 ;;
esac

install_dependencies
jobs=$(nproc)

# build PRESET [CMAKE ARGUMENTS...]: configures and builds everything of that preset.
build() {
  local preset=$1
  shift
  cmake --preset "$preset" "$@"
  cmake --build --preset "$preset" -- -j"$jobs"
}

# run_ctest PRESET ARGUMENTS...
run_ctest() {
  local preset=$1
  shift
  ctest --test-dir "build/$preset" --output-on-failure --no-tests=ignore -j"$jobs" "$@"
}

if $everything; then
  build asan
  run_ctest asan -L fuzz
  # What must not crash or leave half-written files, and the kernel with its memory of its own, with sanitizers watching.
  run_ctest asan -LE 'scans|heavy|solvers|fuzz|tsan' \
    -R '[Hh]ostile|FullDisk|FileSizeLimit|FullStandardOutput|RandomComplex|DelTetSurf'
  build/asan/tests/core/core_tests
  build/asan/tests/delaunay/delaunay_tests
  build dev -DDELVOX_BUILD_BENCHMARKS=ON
  run_ctest dev -LE 'fuzz|tsan'
else
  build dev
  run_ctest dev -LE 'scans|heavy|solvers|fuzz|tsan'
fi
