#include "actors/requests/access/role_table.hpp"

#include "actors/edge/http/http_target.hpp"
#include "actors/requests/request_outline.hpp"
#include "messages/failure.hpp"

#include <algorithm>
#include <array>
#include <string>
#include <variant>

namespace roscell {

namespace {

constexpr std::string_view requests_path = "/v1/requests";

bool begins_with(std::string_view text, std::string_view beginning) {
  return text.substr(0, beginning.size()) == beginning;
}

bool ends_with(std::string_view text, std::string_view end) {
  return text.size() >= end.size()
         && text.substr(text.size() - end.size()) == end;
}

/// Queries that show more than how things are: what programs have written, who
/// has done what, or that make a host work.
constexpr std::array<std::string_view, 8> operators_queries{
    "log_query",   "kept_logs_query",       "exec_output_query",
    "reach_query", "examination_query",     "registration_query",
    "audit_query", "identity_request_query"};

constexpr std::array<std::string_view, 2> newcomers_requests{"site_entry",
                                                             "site_renewal"};

bool is_for_newcomers(std::string_view type) {
  return std::find(newcomers_requests.begin(), newcomers_requests.end(), type)
         != newcomers_requests.end();
}

bool is_for_viewers(std::string_view path) {
  return !begins_with(path, builds_path) && path != registration_path
         && !ends_with(path, "/logs");
}

/// What machines of the site ask each other outside of their sessions.
bool is_for_machines(site_role role, std::string_view method,
                     std::string_view path) {
  if (path == registration_path)
    return method == "GET" || role == site_role::coordinator;
  return method == "GET" && (path == hello_path || path == "/healthz");
}

failure refusal_of(const std::string& role, const std::string& what) {
  return {error_code::unauthorized,
          "the role '" + role + "' may not ask for " + what, "",
          role == "viewer" ? "an identity with the role 'operator' may" : "",
          ""};
}

/// Of a role that is none of ours nobody may anything.
site_role role_of(const std::string& word) {
  return role_from(word).value_or(site_role::issuer);
}

} // namespace

bool may_use_path(site_role role, std::string_view method,
                  std::string_view path) {
  switch (role) {
  case site_role::operating:
    return path != registration_path || method == "GET";
  case site_role::viewer:
    return (method == "GET" && is_for_viewers(path)) || path == requests_path;
  case site_role::node:
  case site_role::coordinator:
    return is_for_machines(role, method, path);
  case site_role::issuer:
    break;
  }
  return false;
}

bool may_request(site_role role, std::string_view type) {
  if (role == site_role::operating)
    return true;
  return role == site_role::viewer && is_query(type)
         && std::find(operators_queries.begin(), operators_queries.end(), type)
                == operators_queries.end();
}

std::optional<failure> refuse_by_role(const http_request& request) {
  const bool entry = begins_with(request.path, site_path);
  if (request.role == newcomer_role && entry && request.method == "POST")
    return std::nullopt;
  if (entry && !request.role.empty())
    return refusal_of(request.role, request.method + " " + request.path);
  if (request.role.empty() || request.permitted
      || may_use_path(role_of(request.role), request.method, request.path))
    return std::nullopt;
  return refusal_of(request.role, request.method + " " + request.path);
}

std::optional<failure> refuse_by_type(const std::string& role,
                                      const std::string& type) {
  const bool is_newcomer = role == newcomer_role;
  if (is_for_newcomers(type) != is_newcomer && !type.empty())
    return failure{error_code::unauthorized,
                   is_newcomer
                       ? "who comes for an identity may ask for nothing else"
                       : "only who comes for an identity says a '" + type + "'",
                   "", "`roscell node --invite` and `roscell login` do", ""};
  if (type.empty() || is_newcomer || role.empty()
      || may_request(role_of(role), type))
    return std::nullopt;
  return refusal_of(role, "a '" + type + "'");
}

} // namespace roscell
