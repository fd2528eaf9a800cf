roscell_needs(CLI11)
roscell_needs(spdlog)

# For the full screen of `roscell top`.
find_path(NCURSES_INCLUDE ncurses.h REQUIRED)
find_library(NCURSES_LIBRARY ncursesw REQUIRED)
find_library(TINFO_LIBRARY tinfo REQUIRED)

# Debian ships libedit without a CMake package.
find_path(EDIT_INCLUDE histedit.h REQUIRED)
find_library(EDIT_LIBRARY edit REQUIRED)

# Archives of skills. Debian ships libarchive without a CMake package.
find_path(ARCHIVE_INCLUDE archive.h REQUIRED)
find_library(ARCHIVE_LIBRARY archive REQUIRED)

# For the skills that look at images. OpenCV's CMake package would ask for all
# of its parts; the few that are used are found one by one.
find_path(EIGEN_INCLUDE Eigen/Core PATH_SUFFIXES eigen3 REQUIRED)
find_library(APRILTAG_LIBRARY apriltag REQUIRED)
find_library(PNG_LIBRARY png REQUIRED)
find_library(TURBOJPEG_LIBRARY turbojpeg REQUIRED)
find_path(OPENCV_INCLUDE opencv2/core.hpp PATH_SUFFIXES opencv4 REQUIRED)
foreach(part core imgproc imgcodecs videoio)
  find_library(OPENCV_${part} opencv_${part} REQUIRED)
  add_library(opencv::${part} UNKNOWN IMPORTED)
  set_target_properties(opencv::${part} PROPERTIES
    IMPORTED_LOCATION ${OPENCV_${part}}
    INTERFACE_INCLUDE_DIRECTORIES ${OPENCV_INCLUDE})
endforeach()
