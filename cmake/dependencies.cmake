# Third-party packages, all from Debian 12. docs/decisions.md gives the reasons.

find_package(Threads REQUIRED)
find_package(OpenSSL REQUIRED)
find_package(SQLite3 REQUIRED)
find_package(fastrtps REQUIRED)
find_package(CLI11 REQUIRED)
find_package(spdlog REQUIRED)
# Makes structs from definitions of ROS 2 messages while building.
find_package(Python3 3.9 REQUIRED COMPONENTS Interpreter)

find_path(NLOHMANN_INCLUDE nlohmann/json.hpp REQUIRED)
find_path(VALIJSON_INCLUDE valijson/validator.hpp REQUIRED)
find_path(BOOST_BEAST_INCLUDE boost/beast.hpp REQUIRED)

# Debian ships CAF without a CMake package.
find_path(CAF_INCLUDE caf/all.hpp REQUIRED)
find_library(CAF_CORE caf_core REQUIRED)
add_library(caf::core UNKNOWN IMPORTED)
set_target_properties(caf::core PROPERTIES IMPORTED_LOCATION ${CAF_CORE})
# Without this, an unregistered message type is a silent error at run time.
target_compile_definitions(caf::core INTERFACE CAF_ENABLE_TYPE_ID_CHECKS)

# Beast is header-only; its big parts are compiled once, in actors/edge.
add_library(boost_beast INTERFACE)
target_compile_definitions(boost_beast INTERFACE
  BOOST_ASIO_SEPARATE_COMPILATION BOOST_BEAST_SEPARATE_COMPILATION
  BOOST_ASIO_NO_DEPRECATED)
target_link_libraries(boost_beast INTERFACE Threads::Threads OpenSSL::Crypto)

# For the skills that look at images. OpenCV's CMake package would ask for all
# of its parts; the few that are used are found one by one.
find_path(EIGEN_INCLUDE Eigen/Core PATH_SUFFIXES eigen3 REQUIRED)
find_library(APRILTAG_LIBRARY apriltag REQUIRED)
find_library(PNG_LIBRARY png REQUIRED)
find_library(TURBOJPEG_LIBRARY turbojpeg REQUIRED)
find_library(YAML_CPP_LIBRARY yaml-cpp REQUIRED)
find_path(OPENCV_INCLUDE opencv2/core.hpp PATH_SUFFIXES opencv4 REQUIRED)
foreach(part core imgproc imgcodecs videoio)
  find_library(OPENCV_${part} opencv_${part} REQUIRED)
  add_library(opencv::${part} UNKNOWN IMPORTED)
  set_target_properties(opencv::${part} PROPERTIES
    IMPORTED_LOCATION ${OPENCV_${part}}
    INTERFACE_INCLUDE_DIRECTORIES ${OPENCV_INCLUDE})
endforeach()
