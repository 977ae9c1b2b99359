# The installed package: find_package(snare) gives snare::numerics ... snare::validation.

include(CMakePackageConfigHelpers)
set(SNARE_PACKAGE_DIR "${CMAKE_INSTALL_LIBDIR}/cmake/snare")

configure_package_config_file(cmake/snareConfig.cmake.in snareConfig.cmake
                              INSTALL_DESTINATION "${SNARE_PACKAGE_DIR}")
write_basic_package_version_file(snareConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(EXPORT snareTargets NAMESPACE snare:: DESTINATION "${SNARE_PACKAGE_DIR}")
install(FILES "${PROJECT_BINARY_DIR}/snareConfig.cmake" "${PROJECT_BINARY_DIR}/snareConfigVersion.cmake"
              cmake/FindKLU.cmake cmake/FindSUNDIALS.cmake cmake/SuiteSparseLibrary.cmake
        DESTINATION "${SNARE_PACKAGE_DIR}")
install(FILES LICENSE README.md DESTINATION "${CMAKE_INSTALL_DOCDIR}")

# cmake --build BUILD --target uninstall: takes away what the last installation from this build has put somewhere.
add_custom_target(uninstall
  COMMAND ${CMAKE_COMMAND} "-DBUILD_DIR=${PROJECT_BINARY_DIR}" -P "${PROJECT_SOURCE_DIR}/cmake/uninstall.cmake" VERBATIM)
