#include "actors/edge/http/http_access.hpp"

#include "actors/edge/io/crypto.hpp"
#include "actors/edge/io/plain_text.hpp"

#include <algorithm>
#include <string_view>

namespace roscell {

namespace {

namespace http = boost::beast::http;

std::string_view value_of(const http::request_header<>& x, http::field name) {
  const auto text = x[name];
  return {text.data(), text.size()};
}

bool contains(const std::vector<std::string>& all, std::string_view wanted) {
  return std::find(all.begin(), all.end(), wanted) != all.end();
}

std::string_view bearer_token(const http::request_header<>& x) {
  constexpr std::string_view scheme = "Bearer ";
  const auto value = value_of(x, http::field::authorization);
  return value.substr(0, scheme.size()) == scheme ? value.substr(scheme.size())
                                                  : std::string_view{};
}

bool has_token(const http_access& access, const http::request_header<>& x) {
  return !access.token.empty()
         && equal_in_constant_time(bearer_token(x), access.token);
}

/// Browsers send all that they have for a host, whatever its port.
bool has_cookie(const http_access& access, const http::request_header<>& x) {
  const auto wanted = access.cookie_name + "=" + access.cookie_value;
  auto rest = value_of(x, http::field::cookie);
  bool result = false;
  while (!rest.empty()) {
    auto one = take_until(rest, ';');
    while (!one.empty() && one.front() == ' ')
      one.remove_prefix(1);
    result = equal_in_constant_time(one, wanted) || result;
  }
  return result && !access.cookie_value.empty();
}

/// Whether the server is called as it may be, whatever the port.
bool names_host(const http_access& access, const http::request_header<>& x) {
  const auto value = value_of(x, http::field::host);
  return access.hosts.empty()
         || contains(access.hosts, value.substr(0, value.find(':')));
}

/// Whether a browser says that a page of somebody else asks. It may lead here,
/// as a link does, but not have something done.
bool is_of_foreign_page(const http::request_header<>& x,
                        const std::string& scheme = "http://") {
  const auto origin = value_of(x, http::field::origin);
  if (!origin.empty()
      && origin != scheme + std::string{value_of(x, http::field::host)})
    return true;
  const auto site = x["Sec-Fetch-Site"];
  return x.method() != http::verb::get && site == "cross-site";
}

} // namespace

bool has_permit(const http_access& access, const http::request_header<>& x,
                const std::string& path, const std::string& from) {
  return access.permits && x.method() == http::verb::get
         && access.permits(path, bearer_token(x), from);
}

std::optional<http_refusal>
refuse_foreign_page(const http::request_header<>& x) {
  if (!is_of_foreign_page(x, "https://"))
    return std::nullopt;
  return http_refusal{403, error_code::unauthorized,
                      "a page from elsewhere may not ask this server", ""};
}

bool http_access::has_secret(const std::string& path) const {
  const auto size = path_secret.size();
  return size > 0 && path.size() > size + 1 && path[size + 1] == '/'
         && equal_in_constant_time(std::string_view{path}.substr(1, size),
                                   path_secret);
}

std::string http_access::without_secret(std::string path) const {
  if (has_secret(path))
    path.erase(0, path_secret.size() + 1);
  return path;
}

std::variant<http_caller, http_refusal>
find_caller(const http_access& access, const http::request_header<>& x,
            const std::string& path, const std::string& from) {
  if (!names_host(access, x))
    return http_refusal{403, error_code::unauthorized,
                        "the Host header does not name this server", ""};
  if (has_token(access, x) || has_permit(access, x, path, from))
    return http_caller::trusted;
  const bool knows = has_cookie(access, x);
  const bool links = access.has_secret(path);
  if ((knows || links) && is_of_foreign_page(x))
    return http_refusal{403, error_code::unauthorized,
                        "a page from elsewhere may not ask this server", ""};
  if (links && (knows || !access.link_spent))
    return http_caller::follows_link;
  if (links)
    return http_refusal{401, error_code::unauthorized,
                        "this link was good once", "ask for another one"};
  if (knows)
    return http_caller::trusted;
  if (contains(access.public_paths, path))
    return http_caller::unauthenticated_peer;
  return http_refusal{
      401, error_code::unauthorized, "the bearer token is missing or wrong",
      "the node wrote it to its data directory; on the node's own host "
      "the Unix socket needs none"};
}

} // namespace roscell
