# What the CMake of a skill says, in the tree of ROSCell and outside of it.

# A ready skill: BUILD/skills/NAME with skill.json (or skill.yaml or skill.yml),
# bin/NAME and skill.version, which `cmake --install` puts into
# PREFIX/lib/roscell/skills/NAME, as a part of the install component.
# Its target is NAME_skill.
# roscell_skill(NAME SOURCES file... [LIBRARIES library...]
#               [COMPONENT component, or else skills])
#
# skill.version is a hash of the descriptor and of all sources beside it, so
# that what is compiled from them for several machines is one version.
function(roscell_skill name)
  cmake_parse_arguments(skill "" "COMPONENT" "SOURCES;LIBRARIES" ${ARGN})
  set(folder ${CMAKE_BINARY_DIR}/skills/${name})
  add_executable(${name}_skill ${skill_SOURCES})
  # An expression, so that no generator adds a folder for the configuration.
  set_target_properties(${name}_skill PROPERTIES
    OUTPUT_NAME ${name} RUNTIME_OUTPUT_DIRECTORY ${folder}/bin$<0:>)
  target_link_libraries(${name}_skill PRIVATE roscell::skill ${skill_LIBRARIES}
    $<$<TARGET_EXISTS:roscell_sanitizer_options>:roscell_sanitizer_options>)
  file(GLOB descriptor CONFIGURE_DEPENDS
       RELATIVE ${CMAKE_CURRENT_SOURCE_DIR} skill.json skill.yaml skill.yml)
  list(LENGTH descriptor count)
  if(NOT count EQUAL 1)
    message(FATAL_ERROR "a skill has one descriptor, skill.json, skill.yaml or "
                        "skill.yml; ${CMAKE_CURRENT_SOURCE_DIR} has ${count}")
  endif()
  # What an earlier build left would be a second one.
  set(others skill.json skill.yaml skill.yml)
  list(REMOVE_ITEM others ${descriptor})
  list(TRANSFORM others PREPEND ${folder}/)
  file(REMOVE ${others})
  file(GLOB sources CONFIGURE_DEPENDS *.cpp *.hpp *.cc *.h *.c */msg/*.msg)
  list(TRANSFORM skill_SOURCES PREPEND ${CMAKE_CURRENT_SOURCE_DIR}/
    REGEX "^[^/]")
  list(APPEND sources ${skill_SOURCES} ${CMAKE_CURRENT_SOURCE_DIR}/${descriptor})
  list(REMOVE_DUPLICATES sources)
  set(script ${CMAKE_CURRENT_FUNCTION_LIST_DIR}/skill_version.cmake)
  add_custom_command(OUTPUT ${folder}/skill.version
    COMMAND ${CMAKE_COMMAND} "-DFILES=${sources}"
      -DBELOW=${CMAKE_CURRENT_SOURCE_DIR} -DTO=${folder}/skill.version
      -P ${script}
    DEPENDS ${sources} ${script} VERBATIM)
  # The descriptor comes with the program: a skill that was not built has none.
  add_custom_command(OUTPUT ${folder}/${descriptor}
    COMMAND ${CMAKE_COMMAND} -E copy
      ${CMAKE_CURRENT_SOURCE_DIR}/${descriptor} ${folder}/${descriptor}
    DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/${descriptor} VERBATIM)
  target_sources(${name}_skill
    PRIVATE ${folder}/skill.version ${folder}/${descriptor})
  roscell_install_skill(${name} ${descriptor} "${skill_COMPONENT}")
endfunction()

# INTERNAL to this file. What was not built is left out.
function(roscell_install_skill name descriptor component)
  if(component STREQUAL "")
    set(component skills)
  endif()
  set(folder ${CMAKE_BINARY_DIR}/skills/${name})
  set(place lib/roscell/skills/${name})
  install(TARGETS ${name}_skill
    RUNTIME DESTINATION ${place}/bin COMPONENT ${component} OPTIONAL)
  install(FILES ${folder}/${descriptor} ${folder}/skill.version
    DESTINATION ${place} COMPONENT ${component} OPTIONAL)
endfunction()

# Structs of ROS 2 messages, made from their definitions, in a target that is
# there already: "roscell/ros2/PACKAGE.hpp" for each package of the files.
# roscell_messages(TARGET FILES PACKAGE/msg/TYPE.msg...)
#
# Fields may be messages of the other files and of the packages that ROSCell
# has. Needs Python 3 while building.
function(roscell_messages target)
  cmake_parse_arguments(messages "" "" "FILES" ${ARGN})
  find_package(Python3 3.9 REQUIRED COMPONENTS Interpreter)
  set(made ${CMAKE_BINARY_DIR}/made_messages/${target})
  get_property(tool GLOBAL PROPERTY ROSCELL_MESSAGE_GENERATOR)
  get_property(roots GLOBAL PROPERTY ROSCELL_MESSAGE_DEFINITIONS)
  set(packages)
  foreach(file IN LISTS messages_FILES)
    cmake_path(ABSOLUTE_PATH file NORMALIZE)
    cmake_path(GET file PARENT_PATH folder)
    cmake_path(GET folder PARENT_PATH folder)
    cmake_path(GET folder FILENAME package)
    cmake_path(GET folder PARENT_PATH root)
    list(APPEND files_of_${package} ${file})
    list(APPEND packages ${package})
    list(APPEND roots ${root})
  endforeach()
  list(REMOVE_DUPLICATES packages)
  list(REMOVE_DUPLICATES roots)
  list(TRANSFORM roots PREPEND --known=)
  file(GLOB parts_of_tool CONFIGURE_DEPENDS ${tool}/*.py)
  # All are compiled at once: most of what a source costs is what it includes.
  set(all ${made}/all.cpp)
  set(sources)
  set(includes)
  foreach(package IN LISTS packages)
    set(results ${made}/roscell/ros2/${package}.hpp ${made}/${package}.cpp)
    list(APPEND sources ${results})
    string(APPEND includes "#include \"${package}.cpp\"\n")
    add_custom_command(OUTPUT ${results}
      COMMAND ${Python3_EXECUTABLE} -B ${tool} --to ${made}
        ${roots} ${files_of_${package}}
      DEPENDS ${files_of_${package}} ${parts_of_tool} VERBATIM)
  endforeach()
  file(CONFIGURE OUTPUT ${all} CONTENT "${includes}" @ONLY)
  set_source_files_properties(${all} PROPERTIES OBJECT_DEPENDS "${sources}")
  target_sources(${target} PRIVATE ${all})
  target_include_directories(${target} PUBLIC $<BUILD_INTERFACE:${made}>)
endfunction()
