#include "actors/requests/timed_log.hpp"

#include "actors/edge/io/time_text.hpp"
#include "schemas/base64.hpp"

#include <cstddef>

namespace roscell {

std::string timed_log::add(const log_excerpt& part) {
  const auto text = from_base64(part.bytes).value_or("");
  const auto& said = part.bytes.empty() ? part.text : text;
  if (part.times_unix_ms.empty())
    return said;
  std::string result;
  size_t line = 0;
  for (size_t at = 0; at < said.size(); ++line) {
    const auto newline = said.find('\n', at);
    const bool open = newline == std::string::npos;
    const auto end = open ? said.size() : newline + 1;
    const auto time =
        line < part.times_unix_ms.size() ? part.times_unix_ms[line] : 0;
    if (!in_line_)
      result += (time == 0 ? "-" : iso_time(time)) + " ";
    result += said.substr(at, end - at);
    in_line_ = open;
    at = end;
  }
  return result;
}

} // namespace roscell
