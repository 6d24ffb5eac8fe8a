#!/usr/bin/env bash
# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause

# Sourced by the scripts in Testing and Examples, and by ParaViewPlugin/prepare.sh. Removes --install from their
# arguments. Packages are installed only with --install, or in continuous integration (CI is set).

# Use the distribution's compilers, CMake and Python, which match the distribution's VTK, even if others come first on
# the caller's PATH.
export PATH="/usr/bin:/bin:$PATH" CC=/usr/bin/gcc CXX=/usr/bin/g++

[[ -z "${CI:-}" ]] || export DHM_INSTALL=yes
remaining_arguments=()
for argument in "$@"; do
  if [[ "$argument" == --install ]]; then
    export DHM_INSTALL=yes
  else
    remaining_arguments+=("$argument")
  fi
done
set -- "${remaining_arguments[@]}"

# Packages for building the library, and further packages for the command dhm; rasterio and geopandas are only for
# geographic files and 16-bit images.
build_packages=(g++ cmake ninja-build libvtk9-dev libeigen3-dev)
dhm_packages=(python3-dev python3-numpy python3-click python3-meshio python3-pil
  python3-matplotlib python3-tqdm python3-rasterio python3-geopandas)
# Further packages for the tests.
test_packages=(libgtest-dev openmpi-bin python3-dev python3-mpi4py python3-mpmath python3-numpy python3-scipy
  python3-vtk9 python3-pytest python3-tifffile binutils xvfb xauth proj-bin)

# with_display COMMAND...: runs a command with a virtual display. Programs in a chroot see the sockets of other displays
# but not their locks, so the number of the display is one that no socket has.
with_display()
{
  local number=$((100 + RANDOM % 900))
  while grep -qs "X11-unix/X$number\$" /proc/net/unix; do
    number=$((100 + RANDOM % 900))
  done
  xvfb-run --auto-servernum --server-num="$number" "$@"
}

# list_sources FOLDER...: lists the C++ files of this project in these folders.
list_sources()
{
  find "$@" -type f \( -name '*.cxx' -o -name '*.h' \) | LC_ALL=C sort
}

# install_missing PACKAGE...: installs the Debian packages that are missing, if this is allowed.
install_missing()
{
  local package missing=() as_root=()
  for package in "$@"; do
    if [[ "$(dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null)" != installed ]]; then
      missing+=("$package")
    fi
  done
  if ((${#missing[@]} == 0)); then
    return
  fi
  if [[ "${DHM_INSTALL:-}" != yes ]]; then
    echo "Missing packages: ${missing[*]}" >&2
    echo "Install them, or call this script with --install, which does." >&2
    return 1
  fi
  if ((EUID != 0)); then
    if ! command -v sudo >/dev/null; then
      echo "These packages are needed, and installing them takes root or sudo: ${missing[*]}" >&2
      return 1
    fi
    as_root=(sudo)
  fi
  echo "Installing ${missing[*]}"
  "${as_root[@]}" apt-get update
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
    apt-get install --yes --no-install-recommends "${missing[@]}"
}

# build_dhm: builds the library with the Python package and the command dhm, and nothing else, in the repository's
# folder.
build_dhm()
{
  echo "Configuring"
  cmake --log-level=WARNING -G Ninja -S . -B build/dhm -DPython3_EXECUTABLE=/usr/bin/python3 \
    -DBUILD_TESTING=OFF
  echo "Building"
  cmake --build build/dhm
  dhm_program="$PWD/build/dhm/bin/dhm"
  export PYTHONPATH="$PWD/build/dhm/lib/python3/dist-packages"
}

# dhm ARGUMENT...: shows the command and runs it, as build_dhm has built it.
dhm()
{
  echo "+ dhm $*"
  "$dhm_program" "$@"
}
