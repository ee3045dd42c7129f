# SPDX-License-Identifier: Apache-2.0
# A law of the house: every test has a limit, so that one that hangs ends and is named. Usage:
# cmake -D CTEST=... -D BUILD=... -P time_limits.cmake
execute_process(COMMAND ${CTEST} --show-only=json-v1 WORKING_DIRECTORY ${BUILD}
  OUTPUT_VARIABLE listing COMMAND_ERROR_IS_FATAL ANY)
string(JSON count LENGTH "${listing}" tests)
if(count EQUAL 0)
  message(FATAL_ERROR "\"${BUILD}\" lists no tests")
endif()
math(EXPR last "${count} - 1")
foreach(i RANGE ${last})
  string(JSON name GET "${listing}" tests ${i} name)
  string(JSON properties ERROR_VARIABLE none GET "${listing}" tests ${i} properties)
  if(NOT properties MATCHES "\"TIMEOUT\"")
    list(APPEND without ${name})
  endif()
endforeach()
if(without)
  list(JOIN without " " without)
  message(FATAL_ERROR "tests without TIMEOUT: ${without}")
endif()
message(STATUS "${count} tests have a limit")
