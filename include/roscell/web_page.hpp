#pragma once

#include <map>
#include <string>
#include <string_view>

namespace roscell {

/// What a browser is shown at one path. Both texts live as long as the program.
struct web_page {
  std::string_view content_type; ///< "text/html; charset=utf-8"
  std::string_view body;
};

/// By path, "/dashboard/" and the like.
using web_pages = std::map<std::string, web_page>;

} // namespace roscell
