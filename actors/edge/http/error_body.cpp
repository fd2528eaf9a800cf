#include "actors/edge/http/error_body.hpp"

#include <nlohmann/json.hpp>

namespace roscell {

std::string error_body(error_code code, std::string_view message,
                       std::string_view hint, std::string_view where) {
  using json = nlohmann::json;
  const json body{{"type", "error"},
                  {"error",
                   {{"code", to_word(code)},
                    {"message", message},
                    {"where", where},
                    {"hint", hint}}}};
  return body.dump(-1, ' ', false, json::error_handler_t::replace);
}

} // namespace roscell
