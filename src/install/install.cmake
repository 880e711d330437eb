# What `cmake --install` puts where: the library, its public headers, the program, and what find_package(delvox) needs.
# Headers of src/ stay private.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

install(TARGETS delvox EXPORT delvox-targets)
install(TARGETS delvox_cli)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/delvox DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} FILES_MATCHING PATTERN "*.h")

set(delvox_config_folder ${CMAKE_INSTALL_LIBDIR}/cmake/delvox)
install(EXPORT delvox-targets NAMESPACE delvox:: DESTINATION ${delvox_config_folder})
configure_package_config_file(
  ${PROJECT_SOURCE_DIR}/src/install/delvox-config.cmake.in ${PROJECT_BINARY_DIR}/delvox-config.cmake
  INSTALL_DESTINATION ${delvox_config_folder})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/delvox-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/delvox-config.cmake ${PROJECT_BINARY_DIR}/delvox-config-version.cmake
  DESTINATION ${delvox_config_folder})
