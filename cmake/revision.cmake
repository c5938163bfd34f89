# Run at every build: writes FILE with the revision of SOURCE, if it has changed.
cmake_minimum_required(VERSION 3.22)
execute_process(COMMAND git -C "${SOURCE}" describe --always --dirty --abbrev=12 OUTPUT_VARIABLE revision
                OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE failed)
if(failed)
  set(revision "unknown")
endif()
file(CONFIGURE OUTPUT "${FILE}" CONTENT "#define ROOMGRAPH_REVISION \"@revision@\"\n" @ONLY)
