# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause

# The files of the library, also used by the tests: the kernel's are compiled into KernelTests.
# Paths are relative to this folder.

# Pure mathematics: nothing of VTK may be included here.
set(kernel_sources
  Kernel/ContourChart.cxx
  Kernel/EdgeLanes.cxx
  Kernel/ExactSign.cxx
  Kernel/SmoothChart.cxx)
set(kernel_headers
  Kernel/ContourChart.h
  Kernel/CoordinateSystem.h
  Kernel/EdgeLanes.h
  Kernel/ExactSign.h
  Kernel/Geometry.h
  Kernel/LinearChart.h
  Kernel/OneSidedDerivative.h
  Kernel/RootFinding.h
  Kernel/SmoothChart.h
  Kernel/Vectorize.h)

# From VTK's meshes to the kernel and back.
set(mesh_sources
  Mesh/ChartedTriangulation.cxx
  Mesh/Embedding.cxx
  Mesh/Homeomorphism.cxx
  Mesh/HomeomorphismCache.cxx
  Mesh/JacobianJump.cxx
  Mesh/LargeArray.cxx
  Mesh/MeshProblem.cxx
  Mesh/MeshValidation.cxx
  Mesh/PointLocation.cxx
  Mesh/Triangulation.cxx
  Mesh/TriangulationPair.cxx)
set(mesh_headers
  Mesh/Box.h
  Mesh/BoxTree.h
  Mesh/ChartedTriangulation.h
  Mesh/Embedding.h
  Mesh/Homeomorphism.h
  Mesh/HomeomorphismCache.h
  Mesh/JacobianJump.h
  Mesh/LargeArray.h
  Mesh/MeshProblem.h
  Mesh/MeshValidation.h
  Mesh/PointLocation.h
  Mesh/Triangulation.h
  Mesh/TriangulationPair.h
  Mesh/Vector3.h)

# What the VTK classes share.
set(support_sources
  AttributeTransport.cxx
  CoordinateLines.cxx
  EdgeCrossings.cxx
  ImageSampling.cxx
  InnerLines.cxx
  MeasuredPlaces.cxx
  ProcessStatistics.cxx
  Stars.cxx)
set(support_headers
  AttributeTransport.h
  CellPoints.h
  CoordinateLines.h
  EdgeCrossings.h
  FilterSupport.h
  ImageSampling.h
  InnerLines.h
  MeasuredPlaces.h
  ProcessStatistics.h
  Stars.h)

# Which products and sums are fused into one rounding must not be the compiler's choice: results
# would change from one machine to another. Nobody asks for floating-point exceptions or errno: without
# them, loops over several points become vector instructions.
set(floating_point_options
  $<$<CXX_COMPILER_ID:GNU,Clang,AppleClang>:-ffp-contract=off;-fno-trapping-math;-fno-math-errno>)

# Only in a build of our own: inside VTK, VTK decides.
set(warning_options)
if (CMAKE_PROJECT_NAME STREQUAL "DifferentiableHomeomorphism")
  set(warning_options
    $<$<CXX_COMPILER_ID:GNU,Clang,AppleClang>:-Wall;-Wextra;-Wshadow;-Wconversion>
    # To Clang a part of -Wconversion, to GCC not.
    $<$<CXX_COMPILER_ID:Clang,AppleClang>:-Wno-sign-conversion>)
endif ()
