# Target helpers: every library, application and test of the project is made by one of these.
include(GNUInstallDirs)
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY "${CMAKE_BINARY_DIR}/bin")
set(CMAKE_LIBRARY_OUTPUT_DIRECTORY "${CMAKE_BINARY_DIR}/lib")
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
# Libraries are looked for relative to the program, in the build folder as in the installed tree: what is built does not depend on
# where. CMake's own build paths would end in an empty one, too, by which the loader looks for every library in the working directory.
set(CMAKE_INSTALL_RPATH "$ORIGIN/../${CMAKE_INSTALL_LIBDIR}" "$ORIGIN/../lib" "$ORIGIN")
list(REMOVE_DUPLICATES CMAKE_INSTALL_RPATH)
set(CMAKE_BUILD_WITH_INSTALL_RPATH ON)
if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE Release)
endif()

# A library that changed inside does not make its users link again.
set(CMAKE_LINK_DEPENDS_NO_SHARED ON)

find_program(ROOMGRAPH_CCACHE ccache)
if(ROOMGRAPH_CCACHE AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  # Relative to the source tree, so that checkouts in several folders share what was compiled.
  set(CMAKE_CXX_COMPILER_LAUNCHER "${CMAKE_COMMAND}" -E env "CCACHE_BASEDIR=${CMAKE_SOURCE_DIR}" CCACHE_NOHASHDIR=1
      "${ROOMGRAPH_CCACHE}")
endif()

add_library(roomgraph_options INTERFACE)
target_compile_features(roomgraph_options INTERFACE cxx_std_20)
# For our own sources: a project that uses the installed libraries has its own idea of warnings.
set(ROOMGRAPH_COMPILE_OPTIONS -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor -Woverloaded-virtual
    -Wimplicit-fallthrough
    -Wno-missing-field-initializers  # designated initialisers leave out members on purpose: they have defaults
    -Wno-restrict  # GCC 12 reports "text" + std::string by mistake (GCC bug 105651)
    # Bit-identical results on every run: the compiler must not fuse or reorder floating-point operations.
    -ffp-contract=off
    "-fmacro-prefix-map=${PROJECT_SOURCE_DIR}/="  # __FILE__ does not tell where it was built
    $<$<BOOL:${ROOMGRAPH_WERROR}>:-Werror>)
target_compile_options(roomgraph_options INTERFACE "$<BUILD_INTERFACE:${ROOMGRAPH_COMPILE_OPTIONS}>")
if(ROOMGRAPH_SANITIZE)
  # GCC takes what sanitizers insert for uses of uninitialised values, as its manual says.
  target_compile_options(roomgraph_options INTERFACE -fsanitize=${ROOMGRAPH_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all
                                                     -Wno-maybe-uninitialized)
  target_link_options(roomgraph_options INTERFACE -fsanitize=${ROOMGRAPH_SANITIZE})
  # Eigen would align by hand under AddressSanitizer alone, and Ceres, which is not instrumented, frees what we allocate.
  target_compile_definitions(roomgraph_options INTERFACE EIGEN_MALLOC_ALREADY_ALIGNED=1)
endif()
if(ROOMGRAPH_COVERAGE)
  # Counters of threads are added up one at a time: without that some end below zero.
  target_compile_options(roomgraph_options INTERFACE --coverage -fprofile-update=atomic -Wno-maybe-uninitialized)
  target_link_options(roomgraph_options INTERFACE --coverage)
endif()
install(TARGETS roomgraph_options EXPORT roomgraph-targets)

# roomgraph_add_library(NAME SOURCES ... PUBLIC targets... PRIVATE targets...)
# Shared, so that the class registry exists once however many plug-ins are loaded.
function(roomgraph_add_library name)
  cmake_parse_arguments(ARG "" "" "SOURCES;PUBLIC;PRIVATE" ${ARGN})
  add_library(roomgraph_${name} SHARED ${ARG_SOURCES})
  add_library(roomgraph::${name} ALIAS roomgraph_${name})
  set_target_properties(roomgraph_${name} PROPERTIES EXPORT_NAME ${name} SOVERSION ${PROJECT_VERSION_MAJOR}
                        VERSION ${PROJECT_VERSION})
  target_include_directories(roomgraph_${name} PUBLIC
    $<BUILD_INTERFACE:${CMAKE_CURRENT_SOURCE_DIR}/include> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  target_link_libraries(roomgraph_${name} PUBLIC roomgraph_options ${ARG_PUBLIC} PRIVATE ${ARG_PRIVATE})
  install(TARGETS roomgraph_${name} EXPORT roomgraph-targets LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
  install(DIRECTORY include/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
endfunction()

# Tests see no networks that a developer has installed.
set(ROOMGRAPH_TEST_ENVIRONMENT "XDG_DATA_HOME=${CMAKE_BINARY_DIR}/no_data")

# Each case in a process of its own, as a developer wants it; loading the libraries takes longer than most cases do.
option(ROOMGRAPH_TESTS_ONE_BY_ONE "ctest lists each GoogleTest case, not each executable" OFF)

# roomgraph_add_test(NAME SOURCES ... LINK targets... [INTERNALS libraries...] [ONE_BY_ONE] [AT_ONCE suites...]): one
# GoogleTest executable, and one test of ctest, or one for each case where cases start whole programs (ONE_BY_ONE) or the option
# above wants it; suites of AT_ONCE, which share what takes long to make, are one test even then, and begin before the others.
# It sees the private headers of the library whose tests stand in this folder, and of INTERNALS: the parts behind the public
# interface are tested one by one.
function(roomgraph_add_test name)
  cmake_parse_arguments(ARG "ONE_BY_ONE" "TIMEOUT" "SOURCES;LINK;INTERNALS;AT_ONCE" ${ARGN})
  if(NOT ARG_TIMEOUT)
    set(ARG_TIMEOUT 120)
  endif()
  if(ROOMGRAPH_SANITIZE)  # instrumented programs are several times slower
    math(EXPR ARG_TIMEOUT "20 * ${ARG_TIMEOUT}")
  endif()
  add_executable(${name} ${ARG_SOURCES})
  target_include_directories(${name} PRIVATE ${PROJECT_SOURCE_DIR}/tests/support)
  get_filename_component(tested "${CMAKE_CURRENT_SOURCE_DIR}" NAME)
  foreach(library ${tested} ${ARG_INTERNALS})
    target_include_directories(${name} PRIVATE "${PROJECT_SOURCE_DIR}/libs/${library}/src")
  endforeach()
  target_link_libraries(${name} PRIVATE roomgraph_options ${ARG_LINK} GTest::gmock GTest::gtest_main)
  target_compile_definitions(${name} PRIVATE ROOMGRAPH_SOURCE_DIR="${PROJECT_SOURCE_DIR}"
                             ROOMGRAPH_BINARY_DIR="${CMAKE_BINARY_DIR}")
  if(NOT ARG_ONE_BY_ONE AND NOT ROOMGRAPH_TESTS_ONE_BY_ONE)
    string(REGEX REPLACE "_test$" "" test ${name})
    math(EXPR timeout "2 * ${ARG_TIMEOUT}")
    add_test(NAME ${test} COMMAND ${name} --gtest_brief=1)
    set_tests_properties(${test} PROPERTIES TIMEOUT ${timeout} ENVIRONMENT "${ROOMGRAPH_TEST_ENVIRONMENT}")
    return()
  endif()
  set(filter "*")
  if(ARG_AT_ONCE)
    list(TRANSFORM ARG_AT_ONCE APPEND ".*" OUTPUT_VARIABLE left_out)
    list(JOIN left_out ":" left_out)
    set(filter "-${left_out}")
  endif()
  foreach(suite ${ARG_AT_ONCE})
    add_test(NAME ${suite} COMMAND ${name} --gtest_filter=${suite}.*)
    set_tests_properties(${suite} PROPERTIES COST 200 TIMEOUT ${ARG_TIMEOUT} ENVIRONMENT "${ROOMGRAPH_TEST_ENVIRONMENT}")
  endforeach()
  gtest_discover_tests(${name} DISCOVERY_MODE PRE_TEST DISCOVERY_TIMEOUT 60 TEST_FILTER "${filter}"
                       PROPERTIES TIMEOUT ${ARG_TIMEOUT} ENVIRONMENT "${ROOMGRAPH_TEST_ENVIRONMENT}")
endfunction()
