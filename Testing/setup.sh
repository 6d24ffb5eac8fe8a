#!/usr/bin/env bash
# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause

# Sourced by Testing/run, Examples/run, Examples/figures and ParaViewPlugin/prepare.sh.

# The distribution's compilers, CMake and Python, which go with the distribution's VTK, even if
# others come first on the caller's PATH.
export PATH="/usr/bin:/bin:$PATH" CC=/usr/bin/gcc CXX=/usr/bin/g++

# What the program dhm is built with.
program_packages=(g++ cmake ninja-build libvtk9-dev libcli11-dev nlohmann-json3-dev libcairo2-dev libpng-dev libtiff-dev
  pkg-config)

# install_missing PACKAGE...: installs those Debian packages that are not installed yet.
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
