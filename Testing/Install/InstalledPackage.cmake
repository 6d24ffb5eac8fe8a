# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause

# Installs the build BUILD_DIR into an empty prefix under WORK_DIR, then takes the cpp blocks (point.cxx,
# carry.cxx) and the first cmake block of README as a project, and configures, builds and runs that
# against the prefix.

function (run)
  execute_process(COMMAND ${ARGN} COMMAND_ECHO STDOUT COMMAND_ERROR_IS_FATAL ANY)
endfunction ()

# Writes code blocks of README in the given language to files, the first block to the first file.
function (extract_blocks language)
  file(READ "${README}" text)
  string(PREPEND text "\n")
  set(fence "\n```${language}\n")
  string(LENGTH "${fence}" length)
  foreach (file IN LISTS ARGN)
    string(FIND "${text}" "${fence}" begin)
    if (begin EQUAL -1)
      message(FATAL_ERROR "${README} has no ${language} block for ${file}")
    endif ()
    math(EXPR begin "${begin} + ${length}")
    string(SUBSTRING "${text}" ${begin} -1 text)
    string(FIND "${text}" "\n```" end)
    if (end EQUAL -1)
      message(FATAL_ERROR "A ${language} block of ${README} has no end")
    endif ()
    string(SUBSTRING "${text}" 0 ${end} block)
    file(WRITE "${file}" "${block}\n")
  endforeach ()
endfunction ()

file(REMOVE_RECURSE "${WORK_DIR}")
extract_blocks(cpp "${WORK_DIR}/source/point.cxx" "${WORK_DIR}/source/carry.cxx")
extract_blocks(cmake "${WORK_DIR}/source/CMakeLists.txt")

run("${CMAKE_COMMAND}" --install "${BUILD_DIR}" --config "${CONFIG}" --prefix "${WORK_DIR}/prefix")
run("${CMAKE_COMMAND}" -G "${GENERATOR}" -S "${WORK_DIR}/source" -B "${WORK_DIR}/build"
  "-DCMAKE_BUILD_TYPE=${CONFIG}"
  "-DCMAKE_CXX_COMPILER=${CXX_COMPILER}"
  "-DCMAKE_CXX_FLAGS=${CXX_FLAGS}"
  "-DCMAKE_C_COMPILER=${C_COMPILER}"
  "-DCMAKE_PREFIX_PATH=${WORK_DIR}/prefix"
  "-DCMAKE_RUNTIME_OUTPUT_DIRECTORY=${WORK_DIR}/bin$<0:>")
run("${CMAKE_COMMAND}" --build "${WORK_DIR}/build" --config "${CONFIG}")

# $<0:> above keeps multi-configuration generators from adding a folder.
run("${WORK_DIR}/bin/point")

# The second program carries a triangle's points; in the target the triangle is twice as large.
function (write_triangle file size)
  file(WRITE "${file}" "<VTKFile type=\"PolyData\" version=\"0.1\"><PolyData>
<Piece NumberOfPoints=\"3\" NumberOfPolys=\"1\">
<Points><DataArray type=\"Float64\" NumberOfComponents=\"3\" format=\"ascii\">
0 0 0 ${size} 0 0 0 ${size} 0</DataArray></Points>
<Polys><DataArray type=\"Int64\" Name=\"connectivity\" format=\"ascii\">0 1 2</DataArray>
<DataArray type=\"Int64\" Name=\"offsets\" format=\"ascii\">3</DataArray></Polys>
</Piece></PolyData></VTKFile>
")
endfunction ()
write_triangle("${WORK_DIR}/source.vtp" 1)
write_triangle("${WORK_DIR}/target.vtp" 2)
run("${WORK_DIR}/bin/carry" "${WORK_DIR}/source.vtp" "${WORK_DIR}/target.vtp"
  "${WORK_DIR}/source.vtp" "${WORK_DIR}/result.vtp")
if (NOT EXISTS "${WORK_DIR}/result.vtp")
  message(FATAL_ERROR "The README's pipeline wrote no result.")
endif ()
