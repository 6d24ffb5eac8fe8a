# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause

# Installs the build BUILD_DIR into an empty prefix under WORK_DIR, then takes the first cpp and the
# first cmake block of README as a project, and configures, builds and runs that against the prefix.

function (run)
  execute_process(COMMAND ${ARGN} COMMAND_ECHO STDOUT COMMAND_ERROR_IS_FATAL ANY)
endfunction ()

# Writes the first code block of README in the given language to a file.
function (extract_block language file)
  file(READ "${README}" text)
  string(PREPEND text "\n")
  set(fence "\n```${language}\n")
  string(FIND "${text}" "${fence}" begin)
  if (begin EQUAL -1)
    message(FATAL_ERROR "${README} has no ${language} block")
  endif ()
  string(LENGTH "${fence}" length)
  math(EXPR begin "${begin} + ${length}")
  string(SUBSTRING "${text}" ${begin} -1 text)
  string(FIND "${text}" "\n```" end)
  if (end EQUAL -1)
    message(FATAL_ERROR "The first ${language} block of ${README} has no end")
  endif ()
  string(SUBSTRING "${text}" 0 ${end} text)
  file(WRITE "${file}" "${text}\n")
endfunction ()

file(REMOVE_RECURSE "${WORK_DIR}")
extract_block(cpp "${WORK_DIR}/source/main.cxx")
extract_block(cmake "${WORK_DIR}/source/CMakeLists.txt")

run("${CMAKE_COMMAND}" --install "${BUILD_DIR}" --config "${CONFIG}" --prefix "${WORK_DIR}/prefix")
run("${CMAKE_COMMAND}" -G "${GENERATOR}" -S "${WORK_DIR}/source" -B "${WORK_DIR}/build"
  "-DCMAKE_BUILD_TYPE=${CONFIG}"
  "-DCMAKE_CXX_COMPILER=${CXX_COMPILER}"
  "-DCMAKE_CXX_FLAGS=${CXX_FLAGS}"
  "-DCMAKE_C_COMPILER=${C_COMPILER}"
  "-DCMAKE_PREFIX_PATH=${WORK_DIR}/prefix"
  "-DCMAKE_RUNTIME_OUTPUT_DIRECTORY=${WORK_DIR}/bin$<0:>")
run("${CMAKE_COMMAND}" --build "${WORK_DIR}/build" --config "${CONFIG}")

# The program is the only thing in bin, whatever its name. ($<0:> above keeps multi-configuration
# generators from adding a folder.)
file(GLOB programs "${WORK_DIR}/bin/*")
list(LENGTH programs count)
if (NOT count EQUAL 1)
  message(FATAL_ERROR "The cmake block of ${README} should build one program, but built: ${programs}")
endif ()
run("${programs}")
