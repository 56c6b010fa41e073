# Writes OUT, a header with the commit of the tree SOURCE, when that changed: run by every build, so it is never stale.
# SPDX-License-Identifier: MIT
set(commit unknown)
execute_process(COMMAND git rev-parse --show-prefix WORKING_DIRECTORY ${SOURCE}
  RESULT_VARIABLE failed OUTPUT_VARIABLE prefix OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
if("${failed}" STREQUAL "0" AND "${prefix}" STREQUAL "") # a tree unpacked inside another repository has no commit of its own
  execute_process(COMMAND git describe --always --dirty --abbrev=12 WORKING_DIRECTORY ${SOURCE}
    RESULT_VARIABLE failed OUTPUT_VARIABLE described OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
  if("${failed}" STREQUAL "0" AND NOT "${described}" STREQUAL "")
    set(commit "${described}")
  endif()
endif()
set(text "#define PORTCULLIS_COMMIT \"${commit}\"\n")
set(known "")
if(EXISTS ${OUT})
  file(READ ${OUT} known)
endif()
if(NOT "${text}" STREQUAL "${known}")
  file(WRITE ${OUT} "${text}")
endif()
