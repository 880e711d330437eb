#!/bin/bash
# The Debian packages that delvox is built and tested with: the one list of them. Sourced by run_demo.sh and
# run_tests.sh; run by itself it installs what is missing.

delvox_packages=(
  cmake ninja-build g++ ccache
  libcgal-dev libopenvdb-dev libboost-iostreams-dev libtbb-dev libtiff-dev zlib1g-dev libdeflate-dev libginac-dev
  libhdf5-dev
  nlohmann-json3-dev libcli11-dev libgtest-dev
  calculix-ccx gmsh python3-meshio python3-h5py python3-dolfinx libmed-tools  # what the tests put our files into
  libcgal-demo  # sample volumes: the liver of the demo and of the tests
)

# Installs those of delvox_packages that are missing; asks for a password only if sudo does.
install_dependencies() {
  local package missing=() as_root=()
  for package in "${delvox_packages[@]}"; do
    dpkg-query -W -f='${Status}' "$package" 2>/dev/null | grep -q '^install ok installed' || missing+=("$package")
  done
  [ ${#missing[@]} -eq 0 ] && return 0
  if [ "$(id -u)" -ne 0 ]; then
    command -v sudo >/dev/null || { echo "missing packages, and no sudo to install them: ${missing[*]}" >&2; return 1; }
    as_root=(sudo)
  fi
  echo "installing ${missing[*]}"
  "${as_root[@]}" apt-get update -q
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -q -y --no-install-recommends "${missing[@]}"
}

if [ "${BASH_SOURCE[0]}" = "$0" ]; then
  set -euo pipefail
  install_dependencies
fi
