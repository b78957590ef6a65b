# What `cmake --install` installs: the program with its scenarios, manual page and completions (component runtime), the shared library
# (library) and what it takes to build against it (dev). The Python package installs itself (python/CMakeLists.txt).
include(CMakePackageConfigHelpers)

install(TARGETS driftwright RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT runtime)
install(TARGETS driftwright_shared EXPORT driftwrightTargets
  LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT library NAMELINK_COMPONENT dev)
install(DIRECTORY include/driftwright DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT dev FILES_MATCHING PATTERN "*.hpp")
install(EXPORT driftwrightTargets NAMESPACE driftwright:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/driftwright COMPONENT dev)
file(WRITE ${CMAKE_BINARY_DIR}/driftwrightConfig.cmake "include(\${CMAKE_CURRENT_LIST_DIR}/driftwrightTargets.cmake)\n")
write_basic_package_version_file(${CMAKE_BINARY_DIR}/driftwrightConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_BINARY_DIR}/driftwrightConfig.cmake ${CMAKE_BINARY_DIR}/driftwrightConfigVersion.cmake
  DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/driftwright COMPONENT dev)
install(DIRECTORY scenarios/ DESTINATION ${CMAKE_INSTALL_DATADIR}/driftwright/scenarios COMPONENT runtime
  PATTERN "reader" EXCLUDE PATTERN "*.py" EXCLUDE PATTERN "*.cpp" EXCLUDE PATTERN "*.hpp" EXCLUDE PATTERN "CMakeLists.txt" EXCLUDE)

set(documents ${CMAKE_BINARY_DIR}/documents)
add_custom_command(OUTPUT ${documents}/driftwright.1.gz ${documents}/driftwright.bash ${documents}/_driftwright ${documents}/changelog.gz
  COMMAND ${CMAKE_COMMAND} -D PROGRAM=$<TARGET_FILE:driftwright> -D FOLDER=${documents} -D VERSION=${PROJECT_VERSION}
          -P ${PROJECT_SOURCE_DIR}/cmake/documents.cmake
  DEPENDS driftwright cmake/documents.cmake
  COMMENT "Manual page and completions" VERBATIM)
add_custom_target(documents ALL DEPENDS ${documents}/driftwright.1.gz)
install(FILES ${documents}/driftwright.1.gz DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT runtime)
install(FILES ${documents}/driftwright.bash DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions RENAME driftwright COMPONENT runtime)
install(FILES ${documents}/_driftwright DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions COMPONENT runtime)
