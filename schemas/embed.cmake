# Writes OUTPUT, the definition of `file_schemas()`, from the files SCHEMAS. The
# name of a schema is its file's up to the first dot.

cmake_minimum_required(VERSION 3.25)

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
"#include \"schemas/schema_list.hpp\"

#include <iterator>

namespace roscell {

namespace {

constexpr schema_entry files[] = {
${rows}};

} // namespace

std::vector<schema_entry> file_schemas() {
  return {std::begin(files), std::end(files)};
}

} // namespace roscell
")
