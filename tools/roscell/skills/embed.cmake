# Writes OUTPUT, the definition of `embedded_template()`, from the files of the
# folder TEMPLATE, whose names end with .in.

cmake_minimum_required(VERSION 3.25)
file(GLOB_RECURSE files RELATIVE ${TEMPLATE} ${TEMPLATE}/*.in)
list(SORT files)

set(rows "")
foreach(file IN LISTS files)
  file(READ ${TEMPLATE}/${file} text)
  string(REGEX REPLACE "[.]in$" "" name ${file})
  string(APPEND rows "      {\"${name}\", R\"file(${text})file\"},\n")
endforeach()

file(WRITE ${OUTPUT}
"#include \"tools/roscell/skills/new_skill.hpp\"

namespace roscell::cli {

// It is as long as the files are. NOLINTNEXTLINE(readability-function-size)
const std::vector<new_file>& embedded_template() {
  static const std::vector<new_file> table{
${rows}  };
  return table;
}

} // namespace roscell::cli
")
