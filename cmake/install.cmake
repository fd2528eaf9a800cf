# The CMake package, for find_package(roscell CONFIG COMPONENTS ...), and files
# for pkg-config. Which libraries are in it, roscell_public says.

include(CMakePackageConfigHelpers)
set(package ${CMAKE_INSTALL_LIBDIR}/cmake/roscell)
set(shared ${CMAKE_INSTALL_DATADIR}/roscell)
set(here ${PROJECT_SOURCE_DIR}/cmake)
set(made ${PROJECT_BINARY_DIR}/package)

configure_package_config_file(${here}/roscell-config.cmake.in
  ${made}/roscell-config.cmake INSTALL_DESTINATION ${package}
  PATH_VARS shared NO_SET_AND_CHECK_MACRO)
write_basic_package_version_file(${made}/roscell-config-version.cmake
  COMPATIBILITY SameMinorVersion)
install(EXPORT roscell FILE roscell-targets.cmake NAMESPACE roscell::
  DESTINATION ${package} COMPONENT development)
install(FILES ${made}/roscell-config.cmake ${made}/roscell-config-version.cmake
    ${here}/roscell_skill.cmake ${here}/skill_version.cmake
  DESTINATION ${package} COMPONENT development)
list(TRANSFORM ROSCELL_COMPONENTS REPLACE "(.+)" "${here}/dependencies/\\1.cmake"
  OUTPUT_VARIABLE dependencies)
install(FILES ${dependencies}
  DESTINATION ${package}/dependencies COMPONENT development)

# What makes structs of messages, and the definitions that may be fields.
install(DIRECTORY ${PROJECT_SOURCE_DIR}/tools/generate_messages
  DESTINATION ${shared} COMPONENT development FILES_MATCHING PATTERN *.py)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/skills/ros2/messages/definitions
  DESTINATION ${shared} COMPONENT development FILES_MATCHING PATTERN *.msg)

# The prefix as seen from the file, which may be moved with the rest.
file(RELATIVE_PATH prefix /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
string(REGEX REPLACE "/$" "" prefix ${prefix})
configure_file(${here}/roscell-skill.pc.in ${made}/roscell-skill.pc @ONLY)
install(FILES ${made}/roscell-skill.pc
  DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT development)
