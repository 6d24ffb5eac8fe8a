#!/usr/bin/env bash
# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause

# Sourced by the scripts in Testing and Examples, and by ParaViewPlugin/prepare.sh. Takes the argument --install
# out of theirs: without it, and unless continuous integration runs them (CI is set), no package is installed.

# The distribution's compilers, CMake and Python, which go with the distribution's VTK, even if
# others come first on the caller's PATH.
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

# What the program dhm is built with.
program_packages=(g++ cmake ninja-build libvtk9-dev libeigen3-dev libcli11-dev nlohmann-json3-dev libcairo2-dev libpng-dev libtiff-dev
  pkg-config)
# What the tests need besides.
test_packages=(libgtest-dev openmpi-bin python3-dev python3-mpi4py python3-mpmath python3-numpy python3-scipy
  python3-vtk9 binutils xvfb xauth proj-bin)

# list_sources FOLDER...: the C++ files of this project in these folders.
list_sources()
{
  find "$@" -type f \( -name '*.cxx' -o -name '*.h' \) | LC_ALL=C sort
}

# install_missing PACKAGE...: installs those Debian packages that are not installed yet, if that is allowed.
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

# build_program: builds the program dhm and nothing else, in the repository's folder.
build_program()
{
  echo "Configuring"
  cmake --log-level=WARNING -G Ninja -S . -B build/program \
    -DBUILD_TESTING=OFF -DDHM_BUILD_PROGRAM=ON -DDHM_WRAP_PYTHON=OFF
  echo "Building"
  cmake --build build/program
  program="$PWD/build/program/bin/dhm"
}

# dhm ARGUMENT...: says and does it, with the program that build_program has built.
dhm()
{
  echo "+ dhm $*"
  "$program" "$@"
}
