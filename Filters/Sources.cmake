# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause

# The source files of the library, and compiler options. Paths are relative to this folder.

# Mathematics. These files must not include VTK.
set(kernel_sources
  Kernel/ContourChart.cxx
  Kernel/CubicElement.cxx
  Kernel/ExactSign.cxx
  Kernel/Simd/BendingBatch.cxx
  Kernel/Simd/CubicBatch.cxx
  Kernel/Simd/EdgeBatch.cxx
  Kernel/SmoothChart.cxx)
set(kernel_headers
  Kernel/ContourChart.h
  Kernel/CoordinateSystem.h
  Kernel/CubicElement.h
  Kernel/ExactSign.h
  Kernel/Geometry.h
  Kernel/LinearChart.h
  Kernel/LinearProgram.h
  Kernel/RootFinding.h
  Kernel/RunningError.h
  Kernel/Simd/BendingBatch.h
  Kernel/Simd/CubicBatch.h
  Kernel/Simd/EdgeBatch.h
  Kernel/Simd/Vectorize.h
  Kernel/SmoothChart.h
  Kernel/StripFunction.h)

# The cubic map of a planar pair, which is given as plain arrays. These files must not include VTK.
set(cubic_sources
  Mesh/BendingSolve.cxx
  Mesh/CubicMap.cxx
  Mesh/CubicPreimages.cxx
  Mesh/CubicTemplate.cxx
  Mesh/CubicTriangle.cxx
  Mesh/LargeArray.cxx
  Mesh/LeastBendingDerivatives.cxx
  Mesh/PlanarPair.cxx
  Mesh/VertexGradient.cxx)
set(cubic_headers
  Mesh/BendingSolve.h
  Mesh/CubicMap.h
  Mesh/CubicMapOptions.h
  Mesh/CubicTemplate.h
  Mesh/CubicTriangle.h
  Mesh/LargeArray.h
  Mesh/LeastBendingDerivatives.h
  Mesh/PlanarPair.h
  Mesh/VertexGradient.h)

# Meshes, read and validated once, and the map between two of them.
set(mesh_sources
  Mesh/BoundarySweep.cxx
  Mesh/ChartedTriangulation.cxx
  Mesh/CubicHomeomorphism.cxx
  Mesh/Homeomorphism.cxx
  Mesh/MeshDiagnostic.cxx
  Mesh/MeshGeometry.cxx
  Mesh/MeshValidation.cxx
  Mesh/PointLocation.cxx
  Mesh/Triangulation.cxx
  Mesh/TriangulationPair.cxx)
set(mesh_headers
  Mesh/BoundarySweep.h
  Mesh/Box.h
  Mesh/BoxTree.h
  Mesh/ChartedTriangulation.h
  Mesh/CubicHomeomorphism.h
  Mesh/Homeomorphism.h
  Mesh/MeshDiagnostic.h
  Mesh/MeshGeometry.h
  Mesh/MeshValidation.h
  Mesh/PointBlock.h
  Mesh/PointLocation.h
  Mesh/Triangulation.h
  Mesh/TriangulationPair.h
  Mesh/Vector3.h)

# Whether a map is differentiable: jumps of its Jacobian across edges and at other features.
set(continuity_sources
  Continuity/EdgeCrossings.cxx
  Continuity/InnerLines.cxx
  Continuity/JacobianJump.cxx
  Continuity/MapUnderTest.cxx
  Continuity/MeasuredFeatures.cxx
  Continuity/RayFans.cxx)
set(continuity_headers
  Continuity/EdgeCrossings.h
  Continuity/FeatureKind.h
  Continuity/InnerLines.h
  Continuity/JacobianJump.h
  Continuity/MapUnderTest.h
  Continuity/MeasuredFeatures.h
  Continuity/OneSidedDerivative.h
  Continuity/RayFans.h)

# Pairs that are derived from other pairs, and statistics of pairs.
set(construction_sources
  Construction/InBetweenPath.cxx
  Construction/MapStatistics.cxx
  Construction/PairRefinement.cxx
  Construction/PairStatistics.cxx)
set(construction_headers
  Construction/InBetweenPath.h
  Construction/MapStatistics.h
  Construction/PairRefinement.h
  Construction/PairStatistics.h)

# Pairs that are constructed from landmarks and outlines. These files must not include VTK.
set(figure_sources
  Construction/CommonMap.cxx
  Construction/ConstrainedTriangulation.cxx
  Construction/FaceDissection.cxx
  Construction/FaceFilling.cxx
  Construction/FigureBoundary.cxx
  Construction/FigurePair.cxx
  Construction/GridFilling.cxx
  Construction/IsomorphicTriangulation.cxx
  Construction/JointOptimization.cxx
  Construction/LandmarkResiduals.cxx
  Construction/PairMesh.cxx
  Construction/PairQuality.cxx
  Construction/RegionRefilling.cxx)
set(figure_headers
  Construction/CommonMap.h
  Construction/ConstrainedTriangulation.h
  Construction/FaceDissection.h
  Construction/FaceFilling.h
  Construction/FigureBoundary.h
  Construction/FigurePair.h
  Construction/GridFilling.h
  Construction/IsomorphicTriangulation.h
  Construction/JointOptimization.h
  Construction/LandmarkResiduals.h
  Construction/PairMesh.h
  Construction/PairQuality.h
  Construction/RegionRefilling.h)

# Code shared by the VTK classes.
set(pipeline_sources
  Pipeline/AttributeTransformation.cxx
  Pipeline/CoordinateLines.cxx
  Pipeline/DiagnosticMessages.cxx
  Pipeline/GhostArrays.cxx
  Pipeline/HomeomorphismCache.cxx
  Pipeline/ImageSampling.cxx
  Pipeline/PointBlocks.cxx
  Pipeline/PointsOffSurface.cxx
  Pipeline/ProcessStatistics.cxx
  Pipeline/Requests.cxx)
set(pipeline_headers
  Pipeline/AttributeTransformation.h
  Pipeline/CellPoints.h
  Pipeline/CompositeData.h
  Pipeline/CoordinateLines.h
  Pipeline/DiagnosticMessages.h
  Pipeline/GhostArrays.h
  Pipeline/HomeomorphismCache.h
  Pipeline/ImageSampling.h
  Pipeline/MappedRow.h
  Pipeline/Options.h
  Pipeline/PointBlocks.h
  Pipeline/PointsOffSurface.h
  Pipeline/ProcessStatistics.h
  Pipeline/Requests.h
  Pipeline/VTKVersions.h)

# Products and sums are not contracted to fused operations, because results would differ between machines.
# Floating-point exceptions and errno are not used, and loops over several points are vectorized only without them.
set(floating_point_options
  $<$<CXX_COMPILER_ID:GNU,Clang,AppleClang>:-ffp-contract=off;-fno-trapping-math;-fno-math-errno>)

# Inside VTK, VTK sets the warnings.
set(warning_options)
if (CMAKE_PROJECT_NAME STREQUAL "DifferentiableHomeomorphism")
  set(warning_options
    $<$<CXX_COMPILER_ID:GNU,Clang,AppleClang>:-Wall;-Wextra;-Wshadow;-Wconversion>
    # Clang includes it in -Wconversion, GCC does not.
    $<$<CXX_COMPILER_ID:Clang,AppleClang>:-Wno-sign-conversion>)
endif ()
