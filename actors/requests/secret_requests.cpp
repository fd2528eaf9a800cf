#include "actors/requests/secret_requests.hpp"

#include "messages/secret.hpp"

#include <string_view>
#include <utility>

namespace roscell {

namespace {

bool begins_with(const std::string& text, std::string_view beginning) {
  return text.compare(0, beginning.size(), beginning) == 0;
}

/// Who asks by the Unix socket is a user, and a user has no port.
bool is_of_this_host(const std::string& from) {
  return from.find(':') == std::string::npos
         || begins_with(from, "127.")
         // Who has shown an identity has done so by TLS.
         || begins_with(from, "operator ") || begins_with(from, "[::1]:");
}

} // namespace

std::optional<failure> refuse_from_afar(const std::string& type,
                                        const std::string& from) {
  const bool by_node = begins_with(from, "node ");
  if (type == secret_setting::type && (by_node || !is_of_this_host(from)))
    return failure{error_code::unauthorized,
                   "a secret is set on the host of its node only: from '" + from
                       + "' its value would travel in clear",
                   "", "run `roscell secret set` there, by ssh for instance",
                   ""};
  if ((type == secret_removal::type || type == secret_query::type) && by_node)
    return failure{error_code::unauthorized,
                   "a node answers for its secrets itself, not by its cell", "",
                   "ask it with --to", ""};
  return std::nullopt;
}

failure secret_in_clear(const std::string& node) {
  return {error_code::unauthorized,
          "a secret for node '" + node
              + "' would cross the network in clear: this cell has a token",
          "/node",
          "`roscell site adopt` gives the cell identities; or set it on the "
          "node's own host",
          ""};
}

bool may_be_remembered(const std::string& type) {
  return type != secret_setting::type;
}

failure without_value(const json& document, failure why) {
  constexpr std::string_view got = ", got ";
  if (!document.is_object()
      || document.value("type", json{}) != secret_setting::type)
    return why;
  why.details.clear();
  why.hint = "`roscell secret set` makes the request";
  if (const auto at = why.message.find(got); at != std::string::npos)
    why.message.resize(at);
  return why;
}

} // namespace roscell
