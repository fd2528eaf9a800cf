# Third-party packages, all from Debian 12. docs/decisions.md gives the reasons.
# Each file of dependencies/ has those of one part; an installed package reads
# the same files for the components that it is asked for.

# roscell_needs(PACKAGE...): find_package, which an installed package replaces.
macro(roscell_needs)
  find_package(${ARGV} REQUIRED)
endmacro()

foreach(part IN LISTS ROSCELL_COMPONENTS)
  include(cmake/dependencies/${part}.cmake)
endforeach()
find_path(NLOHMANN_INCLUDE nlohmann/json.hpp REQUIRED)
if("client" IN_LIST ROSCELL_COMPONENTS OR "node" IN_LIST ROSCELL_COMPONENTS)
  find_path(VALIJSON_INCLUDE valijson/validator.hpp REQUIRED)
  find_path(BOOST_BEAST_INCLUDE boost/beast.hpp REQUIRED)

  # Beast is header-only; its big parts are compiled once, in actors/edge.
  add_library(boost_beast INTERFACE)
  target_compile_definitions(boost_beast INTERFACE
    BOOST_ASIO_SEPARATE_COMPILATION BOOST_BEAST_SEPARATE_COMPILATION
    BOOST_ASIO_NO_DEPRECATED)
  target_link_libraries(boost_beast INTERFACE Threads::Threads OpenSSL::Crypto)
endif()
if(ROSCELL_PROGRAMS)
  include(cmake/dependencies/programs.cmake)
endif()
