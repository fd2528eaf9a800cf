# What every target shares: include root, warnings, sanitizers.

add_library(roscell_internal INTERFACE)
target_include_directories(roscell_internal INTERFACE
  ${PROJECT_SOURCE_DIR} ${PROJECT_SOURCE_DIR}/include)
target_compile_options(roscell_internal INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow=local
  $<$<COMPILE_LANGUAGE:CXX>:-Wnon-virtual-dtor>
  # Members have defaults, so that leaving them out is meant.
  -Wno-missing-field-initializers
  $<$<BOOL:${ROSCELL_WERROR}>:-Werror>)

# GCC collects garbage again and again over a large precompiled header; a third
# of the time goes without that, for some 300 MB more of memory.
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  add_compile_options(--param=ggc-min-expand=300 --param=ggc-min-heapsize=1000000)
endif()

set(ROSCELL_SANITIZER_FLAGS)
if(ROSCELL_SANITIZE STREQUAL "address+undefined")
  # CAF 0.17 binds a null reference when a function is spawned without
  # arguments, hence no check for null (docs/decisions.md).
  set(ROSCELL_SANITIZER_FLAGS -fsanitize=address,undefined -fno-sanitize=null
      -fno-sanitize-recover=all -fno-omit-frame-pointer)
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    # GCC's checks of bounds see the sanitizers' own branches and warn of code
    # that cannot run; the release build warns of the real ones.
    list(APPEND ROSCELL_SANITIZER_FLAGS -Wno-array-bounds -Wno-stringop-overflow
         -Wno-maybe-uninitialized)
  endif()
elseif(ROSCELL_SANITIZE STREQUAL "thread")
  set(ROSCELL_SANITIZER_FLAGS -fsanitize=thread -fno-omit-frame-pointer)
elseif(NOT ROSCELL_SANITIZE STREQUAL "")
  message(FATAL_ERROR "ROSCELL_SANITIZE is empty, address+undefined or thread")
endif()
add_compile_options(${ROSCELL_SANITIZER_FLAGS})
add_link_options(${ROSCELL_SANITIZER_FLAGS})
if(ROSCELL_SANITIZE STREQUAL "address+undefined")
  # What the sanitizers add has millions of addresses: at a fixed place nothing
  # has to be moved at each start, and a program has 0.25 instead of 0.65 GB.
  # One object has 180 MB of names of templates for debugging, 5 when compressed.
  add_compile_options(-gz=zlib)
  add_link_options(-Wl,--compress-debug-sections=zlib
    $<$<STREQUAL:$<TARGET_PROPERTY:TYPE>,EXECUTABLE>:-no-pie>)
  # Thin archives name their objects, of which a copy would take 0.7 GB.
  set(CMAKE_CXX_ARCHIVE_CREATE "<CMAKE_AR> qcT <TARGET> <LINK_FLAGS> <OBJECTS>")
  set(CMAKE_CXX_ARCHIVE_APPEND "<CMAKE_AR> qT <TARGET> <LINK_FLAGS> <OBJECTS>")
endif()

if(ROSCELL_TIDY)
  find_program(CLANG_TIDY clang-tidy REQUIRED)
  set(CMAKE_CXX_CLANG_TIDY ${CLANG_TIDY} --quiet)
endif()

# Where programs are installed that nobody types, and skills. The node looks there
# from its own place (actors/edge/host/own_process.hpp).
set(ROSCELL_PRIVATE_FOLDER lib/roscell)

# roscell_unity(target): compiles the sources of each folder together, a few at
# a time, so that a template over messages is instantiated once for all of them.
# A small batch keeps the wait after a change of one file short. CMake's own unity
# sources name the tree's place, so that no other clone of it would find their
# objects in ccache; these name its files. A source with options of its own, which
# must be set before, stays alone.
function(roscell_unity target)
  if(NOT ROSCELL_UNITY)
    return()
  endif()
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    # GCC takes a source that is compiled with others for a header.
    target_compile_options(${target} PRIVATE -Wno-subobject-linkage)
  endif()
  target_include_directories(${target} PRIVATE ${PROJECT_SOURCE_DIR})
  set(groups)
  get_target_property(sources ${target} SOURCES)
  foreach(source IN LISTS sources)
    get_source_file_property(options ${source} COMPILE_OPTIONS)
    get_source_file_property(definitions ${source} COMPILE_DEFINITIONS)
    cmake_path(ABSOLUTE_PATH source OUTPUT_VARIABLE path)
    cmake_path(IS_PREFIX PROJECT_BINARY_DIR ${path} made)
    if(NOT source MATCHES "[.]cpp$" OR options OR definitions OR made)
      continue()
    endif()
    cmake_path(RELATIVE_PATH path BASE_DIRECTORY ${PROJECT_SOURCE_DIR})
    cmake_path(GET path PARENT_PATH folder)
    string(MAKE_C_IDENTIFIER "${folder}" id)
    math(EXPR count_${id} "0${count_${id}} + 1")
    math(EXPR batch "(${count_${id}} - 1) / ${ROSCELL_UNITY_BATCH}")
    list(APPEND groups ${id}_${batch})
    string(APPEND text_${id}_${batch} "#include \"${path}\"\n")
    list(REMOVE_ITEM sources ${source})
  endforeach()
  list(REMOVE_DUPLICATES groups)
  foreach(group IN LISTS groups)
    set(unity ${CMAKE_CURRENT_BINARY_DIR}/${target}_unity/unity_${group}.cpp)
    file(CONFIGURE OUTPUT ${unity} CONTENT "${text_${group}}" @ONLY)
    list(APPEND sources ${unity})
  endforeach()
  set_target_properties(${target} PROPERTIES SOURCES "${sources}")
endfunction()

# roscell_glue(target): code that carries messages between templates. Optimizing
# it further takes a third more time to compile and cannot be seen when it runs.
function(roscell_glue target)
  target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-Og>)
endfunction()

# roscell_library(name FOLDER...): a static library of the .cpp files that lie
# directly in the calling folder or in the folders named after it; `FOLDER/**`
# takes the folders inside that folder too. With PUBLIC_AS NAME in front it is
# for other projects, as roscell::NAME.
function(roscell_library name)
  cmake_parse_arguments(library "" "PUBLIC_AS" "" ${ARGN})
  set(sources)
  foreach(folder . ${library_UNPARSED_ARGUMENTS})
    if(folder MATCHES "^(.*)/[*][*]$")
      file(GLOB_RECURSE found CONFIGURE_DEPENDS ${CMAKE_MATCH_1}/*.cpp)
    else()
      file(GLOB found CONFIGURE_DEPENDS ${folder}/*.cpp)
    endif()
    list(APPEND sources ${found})
  endforeach()
  add_library(${name} STATIC ${sources})
  if(library_PUBLIC_AS)
    roscell_public(${name} ${library_PUBLIC_AS})
  else()
    target_link_libraries(${name} PUBLIC roscell_internal)
  endif()
  roscell_unity(${name})
endfunction()
