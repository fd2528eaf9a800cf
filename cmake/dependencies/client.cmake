# It speaks the messages of a node.
include(${CMAKE_CURRENT_LIST_DIR}/node.cmake)
