# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause

# Fails if LIBRARY exports, by the tool NM, a symbol of anything but a VTK class.
execute_process(COMMAND "${NM}" --dynamic --demangle --defined-only "${LIBRARY}"
  OUTPUT_VARIABLE symbols COMMAND_ERROR_IS_FATAL ANY)
string(REPLACE ";" "," symbols "${symbols}")
string(REPLACE "\n" ";" symbols "${symbols}")
set(count 0)
foreach (symbol IN LISTS symbols)
  string(REGEX REPLACE "^[0-9a-f]+ . " "" name "${symbol}")
  if (name MATCHES "^(typeinfo for |typeinfo name for |vtable for )?vtk")
    math(EXPR count "${count} + 1")
  elseif (NOT name STREQUAL "")
    message(SEND_ERROR "exported: ${name}")
  endif ()
endforeach ()
if (count LESS 100)
  message(FATAL_ERROR "Only ${count} symbols of VTK classes are exported.")
endif ()
message(STATUS "${count} symbols are exported, all of VTK classes")
