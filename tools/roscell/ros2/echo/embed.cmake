# Writes OUTPUT, the definition of `embedded_definitions()`, from the files
# DEFINITIONS, .../PACKAGE/msg/NAME.msg each.

cmake_minimum_required(VERSION 3.25)
list(SORT DEFINITIONS)

set(rows "")
foreach(file IN LISTS DEFINITIONS)
  cmake_path(GET file STEM name)
  cmake_path(GET file PARENT_PATH folder)
  cmake_path(GET folder PARENT_PATH folder)
  cmake_path(GET folder FILENAME package)
  file(READ ${file} text)
  string(APPEND rows "      {\"${package}/msg/${name}\", R\"msg(${text})msg\"},\n")
endforeach()

file(WRITE ${OUTPUT}
"#include \"tools/roscell/ros2/echo/message_library.hpp\"

namespace roscell::cli {

const std::map<std::string, std::string>& embedded_definitions() {
  static const std::map<std::string, std::string> table{
${rows}  };
  return table;
}

} // namespace roscell::cli
")
