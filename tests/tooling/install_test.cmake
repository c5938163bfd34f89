# Run by ctest: cmake -DBUILD= -DSOURCE= -DCOMPILER= -DLIBDIR= -DRAWLOG= -P install_test.cmake
set(work "${BUILD}/install-test")
file(REMOVE_RECURSE "${work}")

function(run)
  execute_process(COMMAND ${ARGV} RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(NOT result EQUAL 0)
    message(FATAL_ERROR "${ARGV}\n${output}")
  endif()
  set(output "${output}" PARENT_SCOPE)
endfunction()

run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${work}/prefix)
foreach(file bin/roomgraph share/roomgraph/objects.ini share/roomgraph/networks.json include/roomgraph/core/config.h
        share/bash-completion/completions/roomgraph share/zsh/site-functions/_roomgraph
        share/fish/vendor_completions.d/roomgraph.fish share/man/man1/roomgraph.1
        ${LIBDIR}/cmake/roomgraph/roomgraph-config.cmake)
  if(NOT EXISTS "${work}/prefix/${file}")
    message(FATAL_ERROR "not installed: ${file}")
  endif()
endforeach()
run(${work}/prefix/bin/roomgraph --version)

run(${CMAKE_COMMAND} -S ${SOURCE} -B ${work}/consumer -DCMAKE_PREFIX_PATH=${work}/prefix
    -DCMAKE_CXX_COMPILER=${COMPILER})
run(${CMAKE_COMMAND} --build ${work}/consumer)
set(share ${work}/prefix/share/roomgraph)
run(${work}/consumer/consumer ${share}/config.ini ${share}/objects.ini ${RAWLOG})
if(NOT output MATCHES "swivel_chair at" OR NOT output MATCHES "41 frames")
  message(FATAL_ERROR "the consumer printed: ${output}")
endif()
