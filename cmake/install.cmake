# What other projects need for find_package(roomgraph); the libraries and headers install themselves.
include(CMakePackageConfigHelpers)
set(ROOMGRAPH_CMAKE_DIR "${CMAKE_INSTALL_LIBDIR}/cmake/roomgraph")

install(EXPORT roomgraph-targets NAMESPACE roomgraph:: DESTINATION ${ROOMGRAPH_CMAKE_DIR})
configure_package_config_file("${CMAKE_CURRENT_LIST_DIR}/roomgraph-config.cmake.in"
                              "${CMAKE_BINARY_DIR}/roomgraph-config.cmake"
                              INSTALL_DESTINATION ${ROOMGRAPH_CMAKE_DIR} PATH_VARS CMAKE_INSTALL_DATADIR)
write_basic_package_version_file("${CMAKE_BINARY_DIR}/roomgraph-config-version.cmake" COMPATIBILITY SameMinorVersion)
install(FILES "${CMAKE_BINARY_DIR}/roomgraph-config.cmake" "${CMAKE_BINARY_DIR}/roomgraph-config-version.cmake"
        DESTINATION ${ROOMGRAPH_CMAKE_DIR})

set(shared_files config.ini objects.ini objects_home.ini networks.json)
list(TRANSFORM shared_files PREPEND "${PROJECT_SOURCE_DIR}/")
install(FILES ${shared_files} DESTINATION ${CMAKE_INSTALL_DATADIR}/roomgraph)
install(DIRECTORY "${PROJECT_SOURCE_DIR}/models" DESTINATION ${CMAKE_INSTALL_DATADIR}/roomgraph PATTERN "*.pt" EXCLUDE)
install(FILES "${PROJECT_SOURCE_DIR}/LICENSE" DESTINATION ${CMAKE_INSTALL_DOCDIR})

# The build folder has the same files at the same place beside the program, as links into the source tree.
set(shared_folder "${CMAKE_BINARY_DIR}/share/roomgraph")
file(MAKE_DIRECTORY "${shared_folder}")
foreach(file ${shared_files} "${PROJECT_SOURCE_DIR}/models")
  get_filename_component(name "${file}" NAME)
  file(RELATIVE_PATH target "${shared_folder}" "${file}")
  file(CREATE_LINK "${target}" "${shared_folder}/${name}" SYMBOLIC)
endforeach()
