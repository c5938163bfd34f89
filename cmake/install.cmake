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

install(FILES "${PROJECT_SOURCE_DIR}/config.ini" "${PROJECT_SOURCE_DIR}/objects.ini"
        "${PROJECT_SOURCE_DIR}/objects_home.ini" "${PROJECT_SOURCE_DIR}/networks.json"
        DESTINATION ${CMAKE_INSTALL_DATADIR}/roomgraph)
install(DIRECTORY "${PROJECT_SOURCE_DIR}/models" DESTINATION ${CMAKE_INSTALL_DATADIR}/roomgraph PATTERN "*.pt" EXCLUDE)
install(FILES "${PROJECT_SOURCE_DIR}/LICENSE" DESTINATION ${CMAKE_INSTALL_DOCDIR})
