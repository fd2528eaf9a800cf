#include "actors/requests/rest_routes.hpp"

#include "actors/edge/http/http_target.hpp"
#include "schemas/document.hpp"

#include <algorithm>
#include <charconv>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

namespace roscell {

namespace {

std::vector<std::string> split(const std::string& path) {
  std::vector<std::string> result;
  size_t begin = 1;
  while (begin <= path.size()) {
    const auto end = std::min(path.find('/', begin), path.size());
    result.push_back(path.substr(begin, end - begin));
    begin = end + 1;
  }
  return result;
}

json_request ask(json document) {
  return {document.dump(-1, ' ', false, json::error_handler_t::replace), ""};
}

failure not_found(const http_request& request) {
  return {
      error_code::unknown_type,
      request.method + " " + request.path + " is not known here", "",
      "the paths are /v1/requests (GET and POST), /v1/registration (the same), "
      "/v1/hello, /v1/node, /v1/cost, /v1/actors/{name}, /v1/cell, /v1/cells, "
      "/v1/tasks, /v1/tasks/{task}, the same with /placement or /trace, "
      "/v1/instances, /v1/instances/{id}, the same with /logs, /v1/skills, "
      "/v1/secrets, /v1/topics, /v1/events, /v1/builds/{hash}, the same with "
      "/manifest or "
      "/pieces/{n} (GET and POST), /metrics and /healthz"};
}

/// A number of the query part: `fallback` if absent, nothing if it is no
/// number that is not negative.
std::optional<int64_t> number(const http_request& request,
                              const std::string& name, int64_t fallback) {
  auto i = request.query.find(name);
  if (i == request.query.end())
    return fallback;
  int64_t result = 0;
  const auto* end = i->second.data() + i->second.size();
  const auto read = std::from_chars(i->second.data(), end, result);
  if (read.ec != std::errc{} || read.ptr != end || result < 0)
    return std::nullopt;
  return result;
}

failure bad_number(const std::string& name) {
  return {error_code::schema_violation,
          "the query parameter '" + name
              + "' must be a whole number that is not negative"};
}

bool flag(const http_request& request, const std::string& name) {
  auto i = request.query.find(name);
  return i != request.query.end() && i->second != "0" && i->second != "false";
}

rest_route past_events_route(const http_request& request, int64_t since) {
  const auto time = number(request, "since_unix_ms", 0);
  if (!time)
    return bad_number("since_unix_ms");
  const auto newest = number(request, "newest", 0);
  if (!newest)
    return bad_number("newest");
  return past_events_request{
      {static_cast<uint64_t>(since), *time, static_cast<uint64_t>(*newest)}};
}

rest_route event_route(const http_request& request) {
  const auto since = number(request, "since", 0);
  if (!since)
    return bad_number("since");
  if (flag(request, "past"))
    return past_events_route(request, *since);
  const bool follow = request.query.count("follow") == 0;
  return event_stream_request{static_cast<uint64_t>(*since),
                              follow || flag(request, "follow")};
}

rest_route log_route(const http_request& request, const std::string& id) {
  log_stream_request result;
  result.query.instance = id;
  const auto tail = number(request, "tail", 0);
  if (!tail)
    return bad_number("tail");
  result.query.tail_lines = *tail;
  if (request.query.count("offset") > 0) {
    const auto offset = number(request, "offset", 0);
    if (!offset)
      return bad_number("offset");
    result.query.offset = *offset;
  }
  result.query.times = flag(request, "times");
  result.query.previous = flag(request, "previous");
  result.follow = flag(request, "follow");
  return result;
}

rest_route registration_route(const http_request& request) {
  json query{{"type", "registration_query"}};
  for (const auto* name : {"nonce", "proof"})
    if (const auto i = request.query.find(name); i != request.query.end())
      query[name] = i->second;
  return ask(std::move(query));
}

/// `?resources=now` has the nodes asked first.
rest_route cell_route(const http_request& request) {
  const auto i = request.query.find("resources");
  if (i == request.query.end())
    return ask({{"type", "cell_query"}});
  if (i->second != "now")
    return failure{error_code::schema_violation,
                   "the query parameter 'resources' can only be 'now'"};
  return ask({{"type", "fresh_cell_query"}});
}

/// `/v1/tasks`, `/v1/tasks/{id}` and the like.
rest_route query_route(const http_request& request,
                       const std::vector<std::string>& parts) {
  const auto& what = parts[1];
  if (parts.size() == 2) {
    if (what == "node")
      return ask({{"type", "node_query"}, {"actors", flag(request, "actors")}});
    if (what == "cost")
      return ask({{"type", "cost_query"}, {"cell", flag(request, "cell")}});
    if (what == "hello")
      return ask({{"type", "hello_query"}});
    if (what == "cell")
      return cell_route(request);
    if (what == "cells")
      return ask({{"type", "cell_list_query"}});
    if (what == "tasks")
      return ask({{"type", "task_query"}});
    if (what == "topics")
      return ask({{"type", "topic_query"}});
    if (what == "instances")
      return ask({{"type", "instance_query"}});
    if (what == "secrets")
      return ask({{"type", "secret_query"}});
    if (what == "skills")
      return ask({{"type", "skill_query"}, {"brief", flag(request, "brief")}});
    if (what == "requests")
      return ask({{"type", "request_trace_query"}});
    if (what == "registration")
      return registration_route(request);
    if (what == "events")
      return event_route(request);
  } else if (parts.size() == 3 && what == "tasks") {
    return ask({{"type", "task_query"}, {"task", parts[2]}});
  } else if (parts.size() == 3 && what == "actors") {
    return ask({{"type", "actor_query"}, {"actor", parts[2]}});
  } else if (parts.size() == 4 && what == "tasks" && parts[3] == "placement") {
    return ask({{"type", "task_placement_query"}, {"task", parts[2]}});
  } else if (parts.size() == 4 && what == "tasks" && parts[3] == "trace") {
    return ask({{"type", "request_trace_query"}, {"subject", parts[2]}});
  } else if (parts.size() == 3 && what == "instances") {
    return ask({{"type", "instance_query"}, {"instance", parts[2]}});
  } else if (parts.size() == 4 && what == "instances" && parts[3] == "logs") {
    return log_route(request, parts[2]);
  }
  return not_found(request);
}

/// What he must not say himself is written in. What is no object is refused as
/// such.
std::string with_member(const std::string& body, const char* name,
                        const std::string& value) {
  auto parsed = parse_document(body);
  auto* document = std::get_if<json>(&parsed);
  if (document == nullptr || !document->is_object())
    return body;
  (*document)[name] = value;
  return document->dump();
}

/// Of one who comes for an identity.
rest_route entry_route(const http_request& request) {
  const auto what = request.path.substr(site_path.size());
  if (what == "entry")
    return json_request{with_member(request.body, "exported", request.exported),
                        "site_entry", request.from, request.role};
  if (what == "renewal")
    return json_request{with_member(request.body, "peer", request.peer),
                        "site_renewal", request.from, request.role};
  return not_found(request);
}

} // namespace

rest_route route_of(const http_request& request) {
  const auto parts = split(request.path);
  if (auto build = build_route(request, parts))
    return std::visit([](auto& x) -> rest_route { return std::move(x); },
                      *build);
  if (request.method == "POST") {
    if (request.path == "/v1/requests")
      return json_request{request.body, "", request.from, request.role};
    if (request.role == newcomer_role)
      return entry_route(request);
    // Open to unauthenticated peers: what it takes is proven in itself.
    if (request.path == registration_path)
      return json_request{request.body, "registration_switch", request.from};
    return not_found(request);
  }
  if (request.path == "/healthz")
    return health_check{};
  if (request.path == "/metrics")
    return metrics_request{format_for(request.accept)};
  if (parts.size() >= 2 && parts[0] == "v1")
    return query_route(request, parts);
  return not_found(request);
}

int http_status(error_code code) {
  switch (code) {
  case error_code::malformed_json:
  case error_code::schema_violation:
    return 400;
  case error_code::unauthorized:
    return 401;
  case error_code::unknown_type:
  case error_code::unknown_node:
  case error_code::unknown_cell:
  case error_code::unknown_task:
  case error_code::unknown_operation:
  case error_code::unknown_model:
  case error_code::unknown_deployment:
    return 404;
  case error_code::task_exists:
  case error_code::conflict:
  case error_code::no_feasible_allocation:
    return 409;
  case error_code::unreachable:
  case error_code::engine_failed:
    return 502;
  case error_code::timeout:
  case error_code::unresolved:
    return 504;
  case error_code::internal:
    break;
  }
  return 500;
}

} // namespace roscell
