roscell_needs(Threads)
roscell_needs(fastcdr)
roscell_needs(fastrtps)
roscell_needs(OpenSSL)
roscell_needs(SQLite3)
find_library(YAML_CPP_LIBRARY yaml-cpp REQUIRED)

# Debian ships CAF without a CMake package.
find_path(CAF_INCLUDE caf/all.hpp REQUIRED)
find_library(CAF_CORE caf_core REQUIRED)
if(NOT TARGET caf::core)
  add_library(caf::core UNKNOWN IMPORTED)
  set_target_properties(caf::core PROPERTIES IMPORTED_LOCATION ${CAF_CORE})
  # Without this, an unregistered message type is a silent error at run time.
  target_compile_definitions(caf::core INTERFACE CAF_ENABLE_TYPE_ID_CHECKS)
endif()
