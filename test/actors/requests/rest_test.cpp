#include "actors/requests/rest.hpp"

#include "messages/codec/json_codec.hpp"
#include "messages/failure.hpp"
#include "test/fixture.hpp"

namespace roscell::test {

namespace {

/// Keeps the reply to one request.
struct kept_reply : reply_sink {
  std::optional<http_reply> given;

  void reply(http_reply x) override {
    given = std::move(x);
  }

  std::shared_ptr<http_stream> stream(std::string) override {
    return nullptr;
  }
};

/// The HTTP handler before a router that never answers.
struct rest_fixture {
  virtual_time time;
  std::vector<caf::response_promise> unanswered;
  caf::actor router;
  http_handler handler;

  rest_fixture() {
    router = time.system.spawn([this](caf::event_based_actor* self) {
      return caf::behavior{[this, self](const route_request&) {
        unanswered.push_back(self->make_response_promise());
      }};
    });
    handler = make_rest_handler(
        time.system,
        {time.context, caf::actor_cast<request_router_actor>(router)});
  }

  ~rest_fixture() {
    unanswered.clear();
    time.kill(router);
  }

  rest_fixture(const rest_fixture&) = delete;
  rest_fixture& operator=(const rest_fixture&) = delete;

  std::shared_ptr<kept_reply> ask(const std::string& method,
                                  const std::string& path) {
    auto result = std::make_shared<kept_reply>();
    http_request request;
    request.method = method;
    request.path = path;
    request.body = R"({"type":"cell_query"})";
    handler(request, responder{result});
    time.settle();
    return result;
  }
};

} // namespace

TEST_CASE_METHOD(rest_fixture, "A request whose router ends is answered",
                 "[rest]") {
  const auto reply = ask("POST", "/v1/requests");
  CHECK_FALSE(reply->given);
  time.kill(router);
  REQUIRE(reply->given);
  CHECK(json::parse(reply->given->body).at("error").at("code")
        == "unreachable");
}

TEST_CASE_METHOD(rest_fixture, "Nothing of a request outlives the router",
                 "[rest]") {
  ask("POST", "/v1/requests");
  ask("GET", "/v1/instances/some/logs");
  CHECK(time.context.directory->rows().size() == 2);
  time.kill(router);
  unanswered.clear(); // A promise keeps what is left of the asker.
  CHECK(time.context.directory->rows().empty());
}

} // namespace roscell::test
