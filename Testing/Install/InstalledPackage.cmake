# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause

# Installs the build BUILD_DIR into an empty prefix under WORK_DIR, moves the prefix, then configures, builds and
# runs the examples in SOURCE_DIR against it.

function (run)
  execute_process(COMMAND ${ARGN}
    OUTPUT_VARIABLE output ECHO_OUTPUT_VARIABLE COMMAND_ECHO STDOUT COMMAND_ERROR_IS_FATAL ANY)
  set(output "${output}" PARENT_SCOPE)
endfunction ()

file(REMOVE_RECURSE "${WORK_DIR}")
run("${CMAKE_COMMAND}" --install "${BUILD_DIR}" --config "${CONFIG}" --prefix "${WORK_DIR}/staging")
file(RENAME "${WORK_DIR}/staging" "${WORK_DIR}/prefix")
run("${CMAKE_COMMAND}" -G "${GENERATOR}" -S "${SOURCE_DIR}" -B "${WORK_DIR}/build"
  "-DCMAKE_BUILD_TYPE=${CONFIG}"
  "-DCMAKE_CXX_COMPILER=${CXX_COMPILER}"
  "-DCMAKE_CXX_FLAGS=${CXX_FLAGS}"
  "-DCMAKE_C_COMPILER=${C_COMPILER}"
  "-DVTK_DIR=${VTK_DIR}"
  "-DCMAKE_PREFIX_PATH=${WORK_DIR}/prefix"
  "-DCMAKE_RUNTIME_OUTPUT_DIRECTORY=${WORK_DIR}/bin$<0:>")
run("${CMAKE_COMMAND}" --build "${WORK_DIR}/build" --config "${CONFIG}")

# Check that installed libraries find each other by their RUNPATH.
file(GLOB_RECURSE libraries "${WORK_DIR}/prefix/*.so" "${WORK_DIR}/prefix/bin/*")
foreach (library IN LISTS libraries)
  if (NOT READELF OR IS_DIRECTORY "${library}")
    continue ()
  endif ()
  # The launcher of dhm is a script.
  file(READ "${library}" magic LIMIT 4 HEX)
  if (NOT magic STREQUAL "7f454c46")
    continue ()
  endif ()
  run("${READELF}" --dynamic "${library}")
  if (output MATCHES "NEEDED[^\n]*libvtkFiltersHomeomorphism" AND NOT output MATCHES "(RUNPATH|RPATH)[^\n]*ORIGIN")
    message(FATAL_ERROR "${library} does not find the library it is installed with.")
  endif ()
endforeach ()

# $<0:> above keeps multi-configuration generators from adding a folder.
run("${WORK_DIR}/bin/MapPoint")
if (NOT output MATCHES "is mapped to \\(0.4, [0-9.]*\\) and back to \\(0.4, 0.5\\)")
  message(FATAL_ERROR "The point does not return.")
endif ()

# A square of two triangles. In the target, it is twice as high on the left.
function (write_square file height)
  file(WRITE "${file}" "<VTKFile type=\"PolyData\" version=\"0.1\"><PolyData>
<Piece NumberOfPoints=\"4\" NumberOfPolys=\"2\">
<Points><DataArray type=\"Float64\" NumberOfComponents=\"3\" format=\"ascii\">
0 0 0 1 0 0 1 1 0 0 ${height} 0</DataArray></Points>
<Polys><DataArray type=\"Int64\" Name=\"connectivity\" format=\"ascii\">0 1 2 0 2 3</DataArray>
<DataArray type=\"Int64\" Name=\"offsets\" format=\"ascii\">3 6</DataArray></Polys>
</Piece></PolyData></VTKFile>
")
endfunction ()
write_square("${WORK_DIR}/source.vtp" 1)
write_square("${WORK_DIR}/target.vtp" 2)
run("${WORK_DIR}/bin/MapFile" "${WORK_DIR}/source.vtp" "${WORK_DIR}/target.vtp"
  "${WORK_DIR}/source.vtp" "${WORK_DIR}/result.vtp")
if (NOT output MATCHES "^0 points are outside" OR NOT EXISTS "${WORK_DIR}/result.vtp")
  message(FATAL_ERROR "The points of the file are not mapped.")
endif ()
run("${WORK_DIR}/bin/MeasureContinuity" "${WORK_DIR}/source.vtp" "${WORK_DIR}/target.vtp")
if (NOT output MATCHES "Linear: 1 creases.*Smooth: 0 creases")
  message(FATAL_ERROR "The continuity of the Jacobian is not measured.")
endif ()

# A file that cannot be read or written is an error.
foreach (arguments "MeasureContinuity;source.vtp;absent.vtp" "MapFile;source.vtp;absent.vtp;source.vtp;result.vtp"
    "MapFile;source.vtp;target.vtp;source.vtp;absent/result.vtp")
  list(POP_FRONT arguments program)
  list(TRANSFORM arguments PREPEND "${WORK_DIR}/")
  execute_process(COMMAND "${WORK_DIR}/bin/${program}" ${arguments} RESULT_VARIABLE status OUTPUT_QUIET ERROR_QUIET)
  if (status EQUAL 0)
    message(FATAL_ERROR "${program} ${arguments} succeeds.")
  endif ()
endforeach ()
