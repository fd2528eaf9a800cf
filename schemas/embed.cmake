# Writes OUTPUT, the definition of `embedded_schemas()`, from the files SCHEMAS.
# The table is sorted by name, which is the file's name up to the first dot.

cmake_minimum_required(VERSION 3.25)
list(SORT SCHEMAS COMPARE FILE_BASENAME)

set(rows "")
foreach(file IN LISTS SCHEMAS)
  get_filename_component(name ${file} NAME_WE)
  file(READ ${file} text)
  string(JSON kind GET "${text}" x-kind)
  string(JSON reply ERROR_VARIABLE none GET "${text}" x-reply)
  if(none)
    set(reply "")
  endif()
  string(APPEND rows
    "  {\"${name}\", \"${kind}\", \"${reply}\", R\"json(${text})json\"},\n")
endforeach()

file(WRITE ${OUTPUT}
"#include \"schemas/embedded_schemas.hpp\"

namespace roscell {

namespace {

constexpr embedded_schema table[] = {
${rows}};

} // namespace

embedded_schema_list embedded_schemas() {
  return {std::begin(table), std::end(table)};
}

} // namespace roscell
")
