#include "actors/core/answer_limits.hpp"
#include "actors/requests/handlers/insight.hpp"
#include "test/actors/requests/processing.hpp"

#include <catch2/catch.hpp>

#include <stdexcept>

namespace roscell::test {

namespace {

struct watched_state {
  static constexpr const char* name = "watched";
};

/// Answers what it is told to, or nothing.
introspected_actor::behavior_type
watched(introspected_actor::stateful_pointer<watched_state> self,
        const std::string& knows) {
  return {
      [self, knows](const state_query&) -> caf::result<actor_state> {
        if (knows.empty())
          return self->make_response_promise<actor_state>();
        return actor_state{knows};
      },
  };
}

struct inspection_fixture {
  virtual_time time;
  std::shared_ptr<node_services> services = std::make_shared<node_services>();
  std::vector<introspected_actor> actors;

  inspection_fixture() {
    services->context = time.context;
  }

  ~inspection_fixture() {
    for (auto& x : actors)
      time.kill(x);
  }

  introspected_actor start(const std::string& knows) {
    actors.push_back(spawn(time.system, time.context, watched, knows));
    time.settle();
    return actors.back();
  }

  caf::expected<request_processed> inspect(const std::string& actor) {
    const auto reply = process(time, services, inspect_actors,
                               {{"type", "actor_query"}, {"actor", actor}});
    time.pass(limits::local::answer);
    REQUIRE(*reply);
    return **reply;
  }

  json rows(const std::string& actor) {
    const auto reply = inspect(actor);
    REQUIRE(reply);
    return json::parse(reply->text).at("actors");
  }
};

} // namespace

TEST_CASE_METHOD(inspection_fixture,
                 "An actor is looked into by its id, or with all of its name",
                 "[inspection]") {
  start(R"({"n":1})");
  const auto second = start(R"({"n":2})");
  const auto both = rows("watched");
  REQUIRE(both.size() == 2);
  CHECK(both[0].at("state") == json{{"n", 1}});
  const auto one = rows(std::to_string(second.id()));
  REQUIRE(one.size() == 1);
  CHECK(one[0].at("state") == json{{"n", 2}});
  CHECK(one[0].at("counters").at("name") == "watched");
}

TEST_CASE_METHOD(inspection_fixture,
                 "An actor that gives no answer in time has its counters",
                 "[inspection]") {
  start("");
  const auto all = rows("watched");
  REQUIRE(all.size() == 1);
  CHECK(all[0].count("state") == 0);
  CHECK(all[0].at("counters").at("name") == "watched");
}

TEST_CASE_METHOD(inspection_fixture, "An actor that has ended is not found",
                 "[inspection]") {
  const auto id = std::to_string(start(R"({"n":1})").id());
  time.kill(actors.back());
  actors.clear();
  const auto reply = inspect(id);
  REQUIRE_FALSE(reply);
  CHECK(to_failure(reply.error()).code == error_code::unknown_task);
  CHECK_FALSE(inspect("nobody"));
}

TEST_CASE("A host is looked at by one at a time, and after a failure again",
          "[host_checking]") {
  int looks = 0;
  std::function<findings()> again;
  const auto look = one_at_a_time([&] {
    ++looks;
    if (looks == 1)
      throw std::runtime_error{"no thread is left"};
    CHECK(again().empty());
    return findings{{judgement::ok, "well"}};
  });
  again = look;
  CHECK_THROWS(look());
  CHECK(look().size() == 1);
  CHECK(looks == 2);
}

TEST_CASE("A program that cannot look at its host says nothing",
          "[host_checking]") {
  CHECK_FALSE(one_at_a_time(nullptr));
}

} // namespace roscell::test
