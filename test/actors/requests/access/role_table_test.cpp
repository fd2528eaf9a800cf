#include "actors/requests/access/role_table.hpp"
#include "schemas/message_catalogue.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <string>
#include <vector>

namespace roscell::test {

namespace {

bool ends_in_query(const std::string& type) {
  return type.size() > 6 && type.compare(type.size() - 6, 6, "_query") == 0;
}

http_request request_of(const std::string& role, const std::string& method,
                        const std::string& path, const std::string& body = {}) {
  http_request result;
  result.role = role;
  result.method = method;
  result.path = path;
  result.body = body;
  return result;
}

bool is_refused(const http_request& x) {
  return refuse_by_role(x).has_value();
}

const std::vector<std::string> shown{
    "/v1/node",       "/v1/cell",   "/v1/cells",  "/v1/tasks",
    "/v1/tasks/pick", "/v1/cost",   "/v1/topics", "/v1/instances",
    "/v1/skills",     "/v1/events", "/metrics",   "/v1/secrets"};

} // namespace

TEST_CASE("a viewer changes nothing, whatever the request", "[requests]") {
  size_t changes = 0;
  size_t queries = 0;
  for (const auto& type : message_types()) {
    if (type.kind != message_kind::request)
      continue;
    const std::string name{type.name};
    const bool may = may_request(site_role::viewer, name);
    INFO(name);
    if (!ends_in_query(name))
      CHECK_FALSE(may);
    (may ? queries : changes) += 1;
    CHECK(may_request(site_role::operating, name));
    CHECK_FALSE(may_request(site_role::node, name));
    CHECK_FALSE(may_request(site_role::coordinator, name));
    CHECK_FALSE(may_request(site_role::issuer, name));
    CHECK(refuse_by_type("viewer", name).has_value() != may);
  }
  CHECK(changes > 15);
  CHECK(queries > 5);
}

TEST_CASE("what programs have written is an operator's", "[requests]") {
  for (const auto* type : {"log_query", "kept_logs_query", "exec_output_query",
                           "audit_query", "identity_request_query"})
    CHECK_FALSE(may_request(site_role::viewer, type));
  CHECK(is_refused(request_of("viewer", "GET", "/v1/instances/a/logs")));
  CHECK_FALSE(
      is_refused(request_of("operator", "GET", "/v1/instances/a/logs")));
  CHECK(is_refused(request_of("viewer", "GET", "/v1/builds/abc")));
}

TEST_CASE("each role has its paths", "[requests]") {
  for (const auto& path : shown) {
    INFO(path);
    CHECK_FALSE(is_refused(request_of("operator", "GET", path)));
    CHECK_FALSE(is_refused(request_of("viewer", "GET", path)));
    CHECK(is_refused(request_of("node", "GET", path)));
    CHECK(is_refused(request_of("coordinator", "GET", path)));
    CHECK(is_refused(request_of("issuer", "GET", path)));
  }
  for (const auto* role : {"node", "coordinator"})
    for (const auto* path : {"/v1/hello", "/healthz", "/v1/registration"})
      CHECK_FALSE(is_refused(request_of(role, "GET", path)));
  // A coordinator switches nodes, and nobody else does.
  for (const auto* role : {"node", "operator", "viewer", "issuer", "king"})
    CHECK(is_refused(request_of(role, "POST", "/v1/registration")));
  CHECK_FALSE(
      is_refused(request_of("coordinator", "POST", "/v1/registration")));
}

TEST_CASE("a permit opens its path to whom it was given", "[requests]") {
  auto request = request_of("node", "GET", "/v1/builds/abc/manifest");
  CHECK(is_refused(request));
  request.permitted = true;
  CHECK_FALSE(is_refused(request));
}

TEST_CASE("who comes for an identity may ask for that, and nobody else may",
          "[requests]") {
  for (const auto* path : {"/v1/site/entry", "/v1/site/renewal"}) {
    CHECK_FALSE(is_refused(request_of(newcomer_role, "POST", path)));
    CHECK(is_refused(request_of(newcomer_role, "GET", path)));
    for (const auto* role :
         {"node", "coordinator", "operator", "viewer", "issuer", "king"})
      CHECK(is_refused(request_of(role, "POST", path)));
  }
  for (const auto& path : shown) {
    CHECK(is_refused(request_of(newcomer_role, "GET", path)));
    CHECK(is_refused(request_of(newcomer_role, "POST", path)));
  }
  for (const auto* path : {"/v1/requests", "/v1/registration", "/healthz"}) {
    CHECK(is_refused(request_of(newcomer_role, "POST", path)));
    CHECK(is_refused(request_of(newcomer_role, "GET", path)));
  }
}

TEST_CASE("what newcomers say nobody else may say, and they nothing else",
          "[requests]") {
  for (const auto& type : message_types()) {
    const std::string name{type.name};
    const bool theirs = name == "site_entry" || name == "site_renewal";
    INFO(name);
    CHECK(refuse_by_type(newcomer_role, name).has_value() != theirs);
    if (theirs)
      for (const auto* role : {"", "operator", "viewer", "node", "coordinator"})
        CHECK(refuse_by_type(role, name));
  }
}

TEST_CASE("who comes by the Unix socket may all", "[requests]") {
  CHECK_FALSE(is_refused(request_of("", "POST", "/v1/registration")));
  CHECK_FALSE(refuse_by_type("", "task_request"));
}

} // namespace roscell::test
