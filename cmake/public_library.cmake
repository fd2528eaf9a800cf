# The libraries for other projects: what is installed of them, and how. A target
# has the same name there, roscell::NAME, as in a project that takes our sources
# by add_subdirectory or FetchContent.

include(GNUInstallDirs)

# roscell_public(TARGET NAME): makes a library one of those for other projects,
# as roscell::NAME. Symbols of theirs stay their own, and nothing of ours but
# the public headers is seen by who links it.
function(roscell_public target name)
  set_target_properties(${target} PROPERTIES
    EXPORT_NAME ${name} OUTPUT_NAME roscell_${name})
  target_compile_features(${target} PUBLIC cxx_std_17)
  target_include_directories(${target} PUBLIC
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include>
    $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  target_link_libraries(${target} PRIVATE $<BUILD_INTERFACE:roscell_internal>)
  # Who links what a sanitizer has seen needs its runtime.
  target_link_options(${target} INTERFACE ${ROSCELL_SANITIZER_FLAGS})
  add_library(roscell::${name} ALIAS ${target})
  set_property(GLOBAL APPEND PROPERTY ROSCELL_PUBLIC_LIBRARIES roscell::${name})
  install(TARGETS ${target} EXPORT roscell COMPONENT development
    ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
  if(ROSCELL_SANITIZE STREQUAL "address+undefined")
    roscell_install_whole(${target})
  endif()
endfunction()

# roscell_install_whole(TARGET): with its objects, where the build has a thin
# archive (targets.cmake).
function(roscell_install_whole target)
  install(CODE "
    execute_process(COMMAND \"${CMAKE_AR}\" t \"$<TARGET_FILE:${target}>\"
      OUTPUT_VARIABLE objects OUTPUT_STRIP_TRAILING_WHITESPACE)
    string(REPLACE \"\\n\" \";\" objects \"\${objects}\")
    set(whole \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_LIBDIR}/$<TARGET_FILE_NAME:${target}>\")
    file(REMOVE \"\${whole}\")
    execute_process(COMMAND \"${CMAKE_AR}\" qc \"\${whole}\" \${objects}
      COMMAND_ERROR_IS_FATAL ANY)"
    COMPONENT development)
endfunction()

# roscell_public_headers(FOLDER_OR_FILE...): headers below include/roscell that
# are installed.
function(roscell_public_headers)
  foreach(name IN LISTS ARGN)
    set(path ${PROJECT_SOURCE_DIR}/include/roscell/${name})
    if(IS_DIRECTORY ${path})
      install(DIRECTORY ${path} COMPONENT development
        DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/roscell
        FILES_MATCHING PATTERN *.hpp)
    else()
      install(FILES ${path} COMPONENT development
        DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/roscell)
    endif()
  endforeach()
endfunction()
