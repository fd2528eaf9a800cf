#pragma once

#include "messages/failure.hpp"

#include <boost/beast/http/fields.hpp>
#include <boost/beast/http/message.hpp>

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace roscell {

/// INTERNAL to this folder: who may ask a server for what by TCP. The Unix
/// socket's clients may ask for all.
struct http_access {
  std::string token; ///< The bearer token; empty: nobody has it.
  /// Begins the path of a link that is good once, for the cookie below; empty:
  /// there is none.
  std::string path_secret;
  std::vector<std::string> hosts;        ///< The server's names; empty: any.
  std::vector<std::string> public_paths; ///< For everybody.
  /// Whether a bearer token lets who asks from an address read this path, and
  /// no other; empty: none does.
  std::function<bool(const std::string& path, std::string_view token,
                     const std::string& from)>
      permits;

  /// What a browser that has followed the link shows from then on: its name
  /// and value, another one for each server.
  std::string cookie_name = "roscell";
  std::string cookie_value;
  bool link_spent = false;

  /// Whether a path begins with the secret.
  bool has_secret(const std::string& path) const;

  /// Without the secret that it begins with, if it does.
  std::string without_secret(std::string path) const;
};

/// Why a request is not answered.
struct http_refusal {
  int status = 400;
  error_code code = error_code::schema_violation;
  std::string message;
  std::string hint;
};

/// Whom a request comes from that is not refused.
enum class http_caller {
  unauthenticated_peer, ///< Who asks for a public path.
  trusted,              ///< Who has shown the token or the cookie.
  follows_link,         ///< Who is to get the cookie, and to go on with that.
};

/// What else lets who asks from an address read this path; the header may hold
/// a permit of the coordinator for it.
bool has_permit(const http_access& access,
                const boost::beast::http::request_header<>& header,
                const std::string& path, const std::string& from);

/// Why a browser that proves itself by its own is not heard: a page of somebody
/// else asks by it.
std::optional<http_refusal>
refuse_foreign_page(const boost::beast::http::request_header<>& header);

/// What the header of a request for `path` tells of who asks.
/// @param from the IP address that it comes from.
std::variant<http_caller, http_refusal>
find_caller(const http_access& access,
            const boost::beast::http::request_header<>& header,
            const std::string& path, const std::string& from);

} // namespace roscell
