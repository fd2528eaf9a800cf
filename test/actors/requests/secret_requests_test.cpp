#include "actors/requests/secret_requests.hpp"

#include "actors/requests/handler_pipeline.hpp"
#include "actors/requests/request_router.hpp"
#include "schemas/utf8.hpp"
#include "test/fixture.hpp"

#include <memory>
#include <string>
#include <vector>

using namespace roscell;
using namespace roscell::test;

namespace {

const std::string hidden_value = to_base64("hidden-value");

/// A router whose node keeps secrets.
struct secret_router : virtual_time {
  secret_router() {
    registry.add(pipeline<secret_setting, secret_set>{
        [this](const request_context&, const secret_setting& x,
               const outcome<secret_set>& done) {
          values.push_back(x.value);
          done.deliver({x.name});
        }});
    services->context = context;
    services->context.events = caf::actor_cast<event_log_actor>(
        system.spawn([this]() -> caf::behavior {
          return {[this](const record_event& x) { published.push_back(x); }};
        }));
    services->name = "arm";
    router = spawn(system, context, request_router,
                   std::make_shared<const request_registry>(registry),
                   std::shared_ptr<const node_services>(services));
  }

  ~secret_router() {
    kill(router);
    kill(services->context.events);
  }

  request_routed set(const std::string& value, const std::string& from,
                     const std::string& id = {}) {
    json request{{"type", "secret_setting"}, {"name", "key"}, {"value", value}};
    if (!id.empty())
      request["request_id"] = id;
    auto reply =
        ask<request_routed>(router, route_request{request.dump(), "", from});
    settle();
    return (*reply)->value();
  }

  request_registry registry;
  std::vector<std::string> values;
  std::vector<record_event> published;
  std::shared_ptr<node_services> services = std::make_shared<node_services>();
  request_router_actor router;
};

bool is_hidden(const std::string& text) {
  return text.find(hidden_value) == std::string::npos
         && text.find("hidden") == std::string::npos;
}

} // namespace

TEST_CASE("a secret is taken from this host, and from no other", "[secrets]") {
  for (const auto* from :
       {"root", "user 1000", "127.0.0.1:40112", "[::1]:40112", "",
        // By TLS, which is not in clear.
        "operator anna at 10.0.0.3:40112"})
    CHECK_FALSE(refuse_from_afar("secret_setting", from));
  for (const auto* from :
       {"10.0.0.3:40112", "192.168.127.1:1", "node head", "[fe80::1]:7",
        "viewer wall at 10.0.0.3:1", "node arm at 10.0.0.3:1"}) {
    const auto why = refuse_from_afar("secret_setting", from);
    REQUIRE(why);
    CHECK(why->code == error_code::unauthorized);
  }
  CHECK_FALSE(refuse_from_afar("secret_query", "10.0.0.3:40112"));
  CHECK_FALSE(refuse_from_afar("secret_removal", "10.0.0.3:40112"));
  CHECK(refuse_from_afar("secret_removal", "node head"));
  CHECK_FALSE(refuse_from_afar("task_request", "10.0.0.3:40112"));
}

TEST_CASE("a router refuses a secret from another host before anybody has it",
          "[secrets]") {
  secret_router b;
  const auto reply = b.set(hidden_value, "10.0.0.3:40112");
  CHECK(reply.refusal == "unauthorized");
  CHECK(is_hidden(reply.text));
  CHECK(b.values.empty());
}

TEST_CASE("nothing of a router remembers the value of a secret", "[secrets]") {
  secret_router b;
  CHECK(b.set(hidden_value, "root", "same").refusal.empty());
  CHECK(b.set(hidden_value, "root", "same").refusal.empty());
  CHECK(b.values.size() == 2);
  auto state = b.ask<actor_state>(b.router, state_query{});
  b.settle();
  const auto known = json::parse((*state)->value().json_text);
  CHECK(known.at("remembered") == 0);
  CHECK(is_hidden(known.dump()));
  for (const auto& x : b.published)
    CHECK(is_hidden(x.subject + x.data));
  for (const auto& x :
       b.services->history->traces("", [](uint64_t) { return ""; }))
    CHECK(is_hidden(json(x).dump()));
}

TEST_CASE("why a secret is no request does not quote its value", "[secrets]") {
  secret_router b;
  for (const auto& value : {std::string{"hidden value"}, std::string{"hidden"},
                            std::string(90'000, 'h') + "hidden"}) {
    const auto reply = b.set(value + "?", "root");
    CHECK(reply.refusal == "schema_violation");
    CHECK(is_hidden(reply.text));
  }
}
