#include "tools/roscell/completion/live_names.hpp"

#include "tools/roscell/exit_code.hpp"

namespace roscell::cli {

namespace {

constexpr std::chrono::milliseconds names_limit{700};
constexpr std::chrono::seconds names_stay{2};

/// Where the names of a kind are: in each item of a list of an answer.
struct name_source {
  std::string_view kind;
  const char* path;
  const char* body;
  const char* list;
  const char* name; ///< JSON pointer in an item.
};

constexpr auto transfers_asked = R"({"type":"transfer_query"})";

constexpr name_source name_sources[] = {
    {"nodes", "/v1/cell", "", "nodes", "/identity/name"},
    {"nodes", "/v1/cell", "", "free", "/name"},
    {"cells", "/v1/cells", "", "cells", "/cell"},
    {"tasks", "/v1/tasks", "", "tasks", "/task"},
    {"instances", "/v1/instances", "", "instances", "/spec/instance"},
    {"actors", "/v1/node?actors=1", "", "actors", "/name"},
    {"transfers", "/v1/requests", transfers_asked, "transfers", "/transfer"},
};

const name_source* source_of(const std::string& kind) {
  for (const auto& x : name_sources)
    if (x.kind == kind)
      return &x;
  return nullptr;
}

} // namespace

std::vector<std::string> names_in(const std::string& kind, const json& reply) {
  std::vector<std::string> result;
  for (const auto& source : name_sources) {
    const auto list = reply.find(source.list);
    if (source.kind != kind || list == reply.end())
      continue;
    const json::json_pointer name{source.name};
    for (const auto& item : *list)
      if (item.contains(name) && item.at(name).is_string())
        result.push_back(item.at(name).get<std::string>());
  }
  return result;
}

const std::vector<std::string>& live_names::of(const std::string& kind) {
  auto& entry = known_[kind];
  const auto* source = source_of(kind);
  const auto now = clock::now();
  const bool is_fresh =
      entry.asked != clock::time_point{} && now - entry.asked < names_stay;
  if (source == nullptr || is_fresh)
    return entry.names;
  entry.asked = now;
  try {
    const std::string request = source->body;
    entry.names = names_in(
        kind, request.empty() ? node_.get(source->path, {names_limit})
                              : node_.ask(json::parse(request), names_limit));
  } catch (const std::runtime_error&) {
    entry.names.clear();
  }
  return entry.names;
}

} // namespace roscell::cli
