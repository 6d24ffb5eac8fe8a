#!/usr/bin/env bash
# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause

# Sets up a private ParaView on Debian, once, in build/paraview-prefix. Run it, or source it to get $paraview_prefix and
# $paraview_dir (for CMake). With --install, missing packages are installed.
#
# Debian's python3-paraview, which has pvpython and ParaView's CMake files, cannot be installed together with
# libvtk9-dev, because the Python modules of both VTKs are in the same folder. So it is unpacked into a separate folder,
# with links to the rest of ParaView, which is installed as usual.
set -euo pipefail
root="$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)"
source "$root/Testing/setup.sh"
paraview_prefix="$root/build/paraview-prefix"

prepare_paraview()
{
  install_missing g++ cmake ninja-build paraview paraview-dev libeigen3-dev mpi-default-dev \
    libdouble-conversion-dev liblz4-dev liblzma-dev libutfcpp-dev python3-dev python3-numpy xvfb xauth
  local version done
  version="$(dpkg-query -W -f='${Version}' paraview)"
  done="$paraview_prefix/complete-$version"
  if [[ -e "$done" ]]; then
    return
  fi
  echo "Making a private ParaView $version"
  rm -rf "$paraview_prefix"
  mkdir -p "$paraview_prefix"
  local package file
  (
    cd "$paraview_prefix"
    apt-get download "python3-paraview=$version"
    dpkg-deb -x python3-paraview_*.deb .
    rm python3-paraview_*.deb
  )
  for package in paraview paraview-dev; do
    dpkg -L "$package"
  done | grep -E '^/usr/(bin|include|lib|share/paraview)' | while read -r file; do
    if [[ ! -d "$file" || -L "$file" ]]; then
      echo "$file"
    fi
  done >"$paraview_prefix/files"
  # Programs search for their Python modules relative to their real location, so they are copied.
  (
    cd "$paraview_prefix"
    grep -v '^/usr/bin/' files | xargs -d '\n' cp --symbolic-link --parents --target-directory=.
    grep '^/usr/bin/' files | xargs -d '\n' cp --no-dereference --parents --target-directory=.
    rm files
    # In newer Debian suites, ParaView's CMake files name Python modules without the tag of the interpreter.
    find usr/lib -name '*.cpython-*.so' | while read -r file; do
      [[ -e "${file%%.cpython-*}.so" ]] || ln -s "$(basename "$file")" "${file%%.cpython-*}.so"
    done
  )
  touch "$done"
}

prepare_paraview
paraview_dir="$(dirname "$(find "$paraview_prefix/usr/lib" -iname 'paraview-config.cmake' -print -quit)")"
