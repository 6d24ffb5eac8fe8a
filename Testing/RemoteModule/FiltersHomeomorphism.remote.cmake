# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause

# For the folder Remote of VTK's source; see Documentation/remote-module.md.
set(VTK_FILTERSHOMEOMORPHISM_REPOSITORY "" CACHE STRING
  "Git repository of the module FiltersHomeomorphism: a URL or a folder")
set(VTK_FILTERSHOMEOMORPHISM_TAG "main" CACHE STRING
  "Branch, tag or commit of the module FiltersHomeomorphism")

vtk_fetch_module(FiltersHomeomorphism
  "Differentiable homeomorphisms between triangulated domains"
  GIT_REPOSITORY "${VTK_FILTERSHOMEOMORPHISM_REPOSITORY}"
  GIT_TAG "${VTK_FILTERSHOMEOMORPHISM_TAG}"
  )
