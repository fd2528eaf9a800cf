# What every target of the house shares: include root, warnings, sanitizers.

add_library(roscell_internal INTERFACE)
target_include_directories(roscell_internal INTERFACE
  $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>)
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

if(ROSCELL_SANITIZE STREQUAL "address+undefined")
  # CAF 0.17 binds a null reference when a function is spawned without
  # arguments, hence no check for null (docs/decisions.md).
  set(flags -fsanitize=address,undefined -fno-sanitize=null
      -fno-sanitize-recover=all -fno-omit-frame-pointer)
elseif(ROSCELL_SANITIZE STREQUAL "thread")
  set(flags -fsanitize=thread -fno-omit-frame-pointer)
elseif(NOT ROSCELL_SANITIZE STREQUAL "")
  message(FATAL_ERROR "ROSCELL_SANITIZE is empty, address+undefined or thread")
endif()
add_compile_options(${flags})
add_link_options(${flags})

if(ROSCELL_TIDY)
  find_program(CLANG_TIDY clang-tidy REQUIRED)
  set(CMAKE_CXX_CLANG_TIDY ${CLANG_TIDY} --quiet)
endif()

# roscell_library(name FOLDER...): a static library of the .cpp files that lie
# directly in the calling folder or in the folders named after it; `FOLDER/**`
# takes the folders inside that folder too.
function(roscell_library name)
  set(sources)
  foreach(folder . ${ARGN})
    if(folder MATCHES "^(.*)/[*][*]$")
      file(GLOB_RECURSE found CONFIGURE_DEPENDS ${CMAKE_MATCH_1}/*.cpp)
    else()
      file(GLOB found CONFIGURE_DEPENDS ${folder}/*.cpp)
    endif()
    list(APPEND sources ${found})
  endforeach()
  add_library(${name} STATIC ${sources})
  target_link_libraries(${name} PUBLIC roscell_internal)
endfunction()
