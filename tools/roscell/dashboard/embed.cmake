# Writes OUTPUT, the definition of `page_files()`, from the files of the
# folder PAGES.

cmake_minimum_required(VERSION 3.25)
file(GLOB_RECURSE files RELATIVE ${PAGES}
  ${PAGES}/*.html ${PAGES}/*.css ${PAGES}/*.js ${PAGES}/*.svg)
list(SORT files)

set(type_html "text/html; charset=utf-8")
set(type_css "text/css; charset=utf-8")
set(type_js "text/javascript; charset=utf-8")
set(type_svg "image/svg+xml")

# A browser that was given the address without its last slash.
set(redirection "<!doctype html><meta charset=utf-8><title>ROSCell</title>")
string(APPEND redirection
  "<meta http-equiv=refresh content=\"0;url=dashboard/\">")
string(CONCAT rows "      {\"/dashboard\",\n"
  "       {\"${type_html}\", R\"~page~(${redirection})~page~\"}},\n")
foreach(file IN LISTS files)
  file(READ ${PAGES}/${file} text)
  # Indentation helps whoever reads the files, and no browser.
  string(REGEX REPLACE "\n +" "\n" text "${text}")
  string(REGEX REPLACE ".*[.]" "" ending ${file})
  string(REGEX REPLACE "^index[.]html$" "" path ${file})
  string(APPEND rows "      {\"/dashboard/${path}\",\n"
    "       {\"${type_${ending}}\", R\"~page~(${text})~page~\"}},\n")
endforeach()

file(WRITE ${OUTPUT}
"#include \"tools/roscell/dashboard/pages.hpp\"

namespace roscell::cli {

// It is as long as the files are. NOLINTNEXTLINE(readability-function-size)
const web_pages& page_files() {
  static const web_pages table{
${rows}  };
  return table;
}

} // namespace roscell::cli
")
