# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause

# Configures a project that has SOURCE_DIR as a subdirectory, and checks that it links to the module and gets none
# of this project's tests, nor its Python package.
file(REMOVE_RECURSE "${WORK_DIR}")
file(WRITE "${WORK_DIR}/source/CMakeLists.txt" "cmake_minimum_required(VERSION 3.25)
project(Consumer LANGUAGES C CXX)
include(CTest)
add_subdirectory(\"${SOURCE_DIR}\" homeomorphism)
find_package(VTK REQUIRED COMPONENTS CommonCore CommonDataModel CommonTransforms)
add_executable(consumer \"${SOURCE_DIR}/Examples/Cxx/MapPoint.cxx\")
target_link_libraries(consumer PRIVATE VTK::FiltersHomeomorphism)
foreach (target IN ITEMS FilterTests KernelTests FiltersHomeomorphismPython)
  if (TARGET \${target})
    message(FATAL_ERROR \"The consumer gets \${target}\")
  endif ()
endforeach ()
")
execute_process(
  COMMAND "${CMAKE_COMMAND}" -G "${GENERATOR}" -S "${WORK_DIR}/source" -B "${WORK_DIR}/build"
    "-DCMAKE_BUILD_TYPE=${CONFIG}"
    "-DCMAKE_CXX_COMPILER=${CXX_COMPILER}"
    "-DCMAKE_CXX_FLAGS=${CXX_FLAGS}"
    "-DCMAKE_C_COMPILER=${C_COMPILER}"
    "-DVTK_DIR=${VTK_DIR}"
  COMMAND_ECHO STDOUT COMMAND_ERROR_IS_FATAL ANY)
file(GLOB_RECURSE headers "${WORK_DIR}/build/homeomorphism/*/vtkFiltersHomeomorphismModule.h")
if (NOT headers)
  message(FATAL_ERROR "Generated files are outside of the build folder.")
endif ()
execute_process(COMMAND "${CMAKE_CTEST_COMMAND}" --test-dir "${WORK_DIR}/build" --show-only
  OUTPUT_VARIABLE tests COMMAND_ERROR_IS_FATAL ANY)
if (NOT tests MATCHES "Total Tests: 0")
  message(FATAL_ERROR "The consumer gets tests: ${tests}")
endif ()
