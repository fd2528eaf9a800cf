#include "actors/requests/rest_routes.hpp"
#include "messages/codec/json_codec.hpp"

#include <catch2/catch.hpp>

namespace roscell::test {

namespace {

http_request get(const std::string& path,
                 const std::map<std::string, std::string>& query = {}) {
  http_request result;
  result.method = "GET";
  result.path = path;
  result.query = query;
  return result;
}

/// The JSON request that a path stands for; null if it is none.
json asked(const http_request& request) {
  const auto route = route_of(request);
  const auto* x = std::get_if<json_request>(&route);
  return x ? json::parse(x->text) : json(nullptr);
}

error_code refused(const http_request& request) {
  const auto route = route_of(request);
  const auto* why = std::get_if<failure>(&route);
  return why ? why->code : error_code{};
}

} // namespace

TEST_CASE("A posted request goes to the router as it is", "[rest_routes]") {
  http_request request;
  request.method = "POST";
  request.path = "/v1/requests";
  request.body = "{not even JSON";
  const auto route = route_of(request);
  REQUIRE(std::holds_alternative<json_request>(route));
  CHECK(std::get<json_request>(route).text == request.body);
}

TEST_CASE("Each path of a table is the query of that table", "[rest_routes]") {
  CHECK(asked(get("/v1/cell")) == json{{"type", "cell_query"}});
  CHECK(asked(get("/v1/cells")) == json{{"type", "cell_list_query"}});
  CHECK(asked(get("/v1/tasks")) == json{{"type", "task_query"}});
  CHECK(asked(get("/v1/instances")) == json{{"type", "instance_query"}});
  CHECK(asked(get("/v1/skills"))
        == json{{"type", "skill_query"}, {"brief", false}});
  CHECK(asked(get("/v1/tasks/t1"))
        == json{{"type", "task_query"}, {"task", "t1"}});
  CHECK(asked(get("/v1/instances/i1"))
        == json{{"type", "instance_query"}, {"instance", "i1"}});
}

TEST_CASE("A coordinator's memory of a task is below the task",
          "[rest_routes]") {
  CHECK(asked(get("/v1/tasks/t1/placement"))
        == json{{"type", "task_placement_query"}, {"task", "t1"}});
  CHECK(asked(get("/v1/tasks/t1/trace"))
        == json{{"type", "request_trace_query"}, {"subject", "t1"}});
  CHECK(asked(get("/v1/requests")) == json{{"type", "request_trace_query"}});
}

TEST_CASE("The nodes are asked for their resources when that is wanted",
          "[rest_routes]") {
  CHECK(asked(get("/v1/cell", {{"resources", "now"}}))
        == json{{"type", "fresh_cell_query"}});
  CHECK(refused(get("/v1/cell", {{"resources", "later"}}))
        == error_code::schema_violation);
}

TEST_CASE("An actor is looked into by name or id", "[rest_routes]") {
  CHECK(asked(get("/v1/actors/member"))
        == json{{"type", "actor_query"}, {"actor", "member"}});
  CHECK(refused(get("/v1/actors")) == error_code::unknown_type);
}

TEST_CASE("What a node costs is asked of it, or of its whole cell",
          "[rest_routes]") {
  CHECK(asked(get("/v1/cost"))
        == json{{"type", "cost_query"}, {"cell", false}});
  CHECK(asked(get("/v1/cost", {{"cell", "true"}}))
        == json{{"type", "cost_query"}, {"cell", true}});
}

TEST_CASE("The node's actors are listed when asked for", "[rest_routes]") {
  CHECK(asked(get("/v1/node")).at("actors") == false);
  CHECK(asked(get("/v1/node", {{"actors", "1"}})).at("actors") == true);
  CHECK(asked(get("/v1/node", {{"actors", ""}})).at("actors") == true);
  CHECK(asked(get("/v1/node", {{"actors", "0"}})).at("actors") == false);
  CHECK(asked(get("/v1/node", {{"actors", "false"}})).at("actors") == false);
}

TEST_CASE(
    "Whoever asks for a proof of a registration gives a nonce and his own",
    "[rest_routes]") {
  CHECK(asked(get("/v1/registration")) == json{{"type", "registration_query"}});
  CHECK(asked(get("/v1/registration", {{"nonce", "ab"}}))
        == json{{"type", "registration_query"}, {"nonce", "ab"}});
  CHECK(asked(get("/v1/registration", {{"nonce", "ab"}, {"proof", "cd"}}))
        == json{
            {"type", "registration_query"}, {"nonce", "ab"}, {"proof", "cd"}});
}

TEST_CASE("Events are followed unless it is refused", "[rest_routes]") {
  auto follow = [](const http_request& x) {
    return std::get<event_stream_request>(route_of(x)).follow;
  };
  CHECK(follow(get("/v1/events")));
  CHECK(follow(get("/v1/events", {{"follow", "1"}})));
  CHECK_FALSE(follow(get("/v1/events", {{"follow", "0"}})));
}

TEST_CASE("The event stream starts after a sequence number", "[rest_routes]") {
  auto since = [](const http_request& x) {
    return std::get<event_stream_request>(route_of(x)).since;
  };
  CHECK(since(get("/v1/events")) == 0);
  CHECK(since(get("/v1/events", {{"since", "17"}})) == 17);
  for (const auto* bad :
       {"-1", "x", "1x", "", " 1", "1e3", "99999999999999999999"})
    CHECK(refused(get("/v1/events", {{"since", bad}}))
          == error_code::schema_violation);
}

TEST_CASE("A log is asked for by offset, tail and follow", "[rest_routes]") {
  auto log = [](const http_request& x) {
    return std::get<log_stream_request>(route_of(x));
  };
  const auto plain = log(get("/v1/instances/i1/logs"));
  CHECK(plain.query.instance == "i1");
  CHECK(plain.query.offset < 0);
  CHECK_FALSE(plain.follow);
  const auto full = log(get("/v1/instances/i1/logs",
                            {{"offset", "0"}, {"tail", "5"}, {"follow", "1"}}));
  CHECK(full.query.offset == 0);
  CHECK(full.query.tail_lines == 5);
  CHECK(full.follow);
  CHECK(refused(get("/v1/instances/i1/logs", {{"tail", "-5"}}))
        == error_code::schema_violation);
  CHECK(refused(get("/v1/instances/i1/logs", {{"offset", "x"}}))
        == error_code::schema_violation);
}

TEST_CASE("The health of a node needs no request", "[rest_routes]") {
  CHECK(std::holds_alternative<health_check>(route_of(get("/healthz"))));
}

TEST_CASE("Any other path is refused with the paths there are",
          "[rest_routes]") {
  for (const auto* path :
       {"/", "", "/v1", "/v2/node", "/v1/nodes", "/v1/node/x", "/v1/tasks/a/b",
        "/v1/tasks/a/trace/b", "/v1/instances/i/log", "/v1/instances/i/logs/x",
        "/healthz/x", "//v1/node", "/v1/request"}) {
    CAPTURE(path);
    CHECK(refused(get(path)) == error_code::unknown_type);
  }
  auto post = get("/v1/node");
  post.method = "POST";
  CHECK(refused(post) == error_code::unknown_type);
  const auto route = route_of(get("/x"));
  CHECK(std::get<failure>(route).hint.find("/v1/events") != std::string::npos);
}

TEST_CASE("Bytes of a path that are no UTF-8 become valid JSON",
          "[rest_routes]") {
  CHECK(asked(get("/v1/tasks/\xff")).at("task") == "\xEF\xBF\xBD");
  CHECK(asked(get("/v1/tasks/a\"b")).at("task") == "a\"b");
}

TEST_CASE("A refusal's status tells who has to act", "[rest_routes]") {
  CHECK(http_status(error_code::malformed_json) == 400);
  CHECK(http_status(error_code::schema_violation) == 400);
  CHECK(http_status(error_code::unauthorized) == 401);
  CHECK(http_status(error_code::unknown_task) == 404);
  CHECK(http_status(error_code::task_exists) == 409);
  CHECK(http_status(error_code::no_feasible_allocation) == 409);
  CHECK(http_status(error_code::engine_failed) == 502);
  CHECK(http_status(error_code::timeout) == 504);
  CHECK(http_status(error_code::internal) == 500);
}

namespace {

const std::string some_hash(64, 'a');

http_request about_build(const std::string& what,
                         const std::map<std::string, std::string>& query = {},
                         const std::string& method = "GET") {
  auto result = get("/v1/builds/" + some_hash + what, query);
  result.method = method;
  return result;
}

/// What is asked of the store of builds; nothing if it is something else.
template <class T>
std::optional<T> asked_of_store(const http_request& request) {
  const auto route = route_of(request);
  const auto* x = std::get_if<build_request>(&route);
  if (x == nullptr || !std::holds_alternative<T>(*x))
    return std::nullopt;
  return std::get<T>(*x);
}

} // namespace

TEST_CASE("What is here of a build, its manifest and its pieces are below it",
          "[rest_routes]") {
  CHECK_FALSE(asked_of_store<build_query>(about_build(""))->wait);
  const auto more =
      asked_of_store<build_query>(about_build("", {{"beyond", "3"}}));
  REQUIRE(more);
  CHECK(more->wait);
  CHECK(more->beyond == 3);
  CHECK(asked_of_store<build_query>(about_build("", {{"beyond", "-1"}}))->wait);
  CHECK(asked_of_store<piece_query>(about_build("/manifest"))->piece == -1);
  CHECK(asked_of_store<piece_query>(about_build("/pieces/7"))->piece == 7);
}

TEST_CASE("A build is given to a node with its manifest, then in pieces",
          "[rest_routes]") {
  auto piece = about_build("/pieces/7", {}, "POST");
  piece.body = "bytes";
  const auto stored = asked_of_store<store_piece>(piece);
  REQUIRE(stored);
  CHECK(stored->piece == 7);
  CHECK(stored->bytes == "bytes");
  auto manifest = about_build(
      "/manifest", {{"manifest", some_hash}, {"bytes", "12"}}, "POST");
  manifest.body = "{}";
  const auto offered = asked_of_store<offer_build>(manifest);
  REQUIRE(offered);
  CHECK(offered->name.bytes == 12);
  CHECK(offered->manifest == "{}");
}

TEST_CASE("A build is asked for by its whole hash and by whole numbers",
          "[rest_routes]") {
  for (const auto* hash : {"aa", "../../etc", "AAAA"})
    CHECK(refused(get(std::string{"/v1/builds/"} + hash))
          == error_code::schema_violation);
  for (const auto* piece : {"-1", "x", "1x", "", "99999999999999999999"})
    CHECK(refused(about_build(std::string{"/pieces/"} + piece))
          == error_code::schema_violation);
  CHECK(refused(about_build("", {{"beyond", "-2"}}))
        == error_code::schema_violation);
  CHECK(refused(about_build("/manifest", {{"bytes", "12"}}, "POST"))
        == error_code::schema_violation);
  CHECK(refused(about_build("/else")) != error_code{});
  CHECK(refused(about_build("", {}, "POST")) != error_code{});
}

} // namespace roscell::test
