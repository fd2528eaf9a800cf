#include "actors/instances/limits.hpp"
#include "test/actors/fakes/instance_bench.hpp"

#include <optional>
#include <string>
#include <vector>

using namespace roscell;
using namespace roscell::test;
using namespace std::chrono_literals;

namespace {

struct ordered_change {
  int64_t number = 0;
  std::string parameters;
};

/// Its program can be given other parameters.
struct tuned_bench : instance_bench {
  using outcome = std::shared_ptr<std::optional<caf::expected<parameters_set>>>;

  tuned_bench() {
    config.row.spec.parameters = R"({"gain":1})";
    config.write_parameters = [this](const std::string& id, int64_t number,
                                     const std::string& text) {
      CHECK(id == "i");
      if (delivery == parameter_delivery::written)
        ordered.push_back({number, text});
      return delivery;
    };
  }

  outcome set(const std::string& parameters) {
    auto result =
        ask<parameters_set>(instance, set_parameters{"i", parameters});
    settle();
    return result;
  }

  void taken(int64_t number) {
    instance_notified x;
    x.instance = "i";
    x.parameters_taken = number;
    caf::anon_send(instance, x);
    settle();
  }

  void refused(int64_t number, const std::string& why) {
    instance_notified x;
    x.instance = "i";
    x.parameters_refused = number;
    x.refusal = why;
    caf::anon_send(instance, x);
    settle();
  }

  std::string spec() const {
    return reported->last().spec.parameters;
  }

  static bool is_set(const outcome& x) {
    return x->has_value() && x->value();
  }

  static failure why_not(const outcome& x) {
    REQUIRE(x->has_value());
    REQUIRE_FALSE(x->value());
    return to_failure(x->value().error());
  }

  parameter_delivery delivery = parameter_delivery::written;
  std::vector<ordered_change> ordered;
};

} // namespace

TEST_CASE("what a program has taken is written down before it is answered") {
  tuned_bench b;
  b.start_ready();
  const auto reply = b.set(R"({"gain": 2})");
  REQUIRE(b.ordered.size() == 1);
  CHECK(b.ordered[0].parameters == R"({"gain":2})");
  CHECK_FALSE(reply->has_value());
  CHECK(b.spec() == R"({"gain":1})");
  const auto writes = b.store->records.size();
  b.taken(b.ordered[0].number);
  CHECK(b.is_set(reply));
  CHECK(b.spec() == R"({"gain":2})");
  REQUIRE(b.store->records.size() == writes + 1);
  CHECK(json::parse(b.store->records.back().value).at("spec").at("parameters")
        == json{{"gain", 2}});
}

TEST_CASE("the same parameters again are answered without a word or a write") {
  tuned_bench b;
  b.start_ready();
  const auto writes = b.store->records.size();
  CHECK(b.is_set(b.set(R"({ "gain" : 1 })")));
  CHECK(b.ordered.empty());
  CHECK(b.store->records.size() == writes);
}

TEST_CASE("a program that has changed its parameters is restarted with them") {
  tuned_bench b;
  b.config.row.spec.life.restart.policy = restart_when::always;
  b.start_ready();
  b.set(R"({"gain":2})");
  b.taken(b.ordered[0].number);
  b.exits(3);
  b.advance(10s);
  REQUIRE(b.runtime->started.size() == 2);
  CHECK(b.runtime->started[1].environment.at("ROSCELL_PARAMETERS")
        == R"({"gain":2})");
}

TEST_CASE("what a program refuses is answered with its reason") {
  tuned_bench b;
  b.start_ready();
  const auto reply = b.set(R"({"gain":2})");
  b.refused(b.ordered[0].number, "too loud");
  const auto why = b.why_not(reply);
  CHECK(why.code == error_code::conflict);
  CHECK(why.message == "the program of instance 'i' refuses: too loud");
  CHECK(b.spec() == R"({"gain":1})");
}

TEST_CASE("a program that does not listen is known at once") {
  tuned_bench b;
  b.start_ready();
  b.delivery = parameter_delivery::no_listener;
  CHECK(b.why_not(b.set(R"({"gain":2})")).message.find("earlier roscell")
        != std::string::npos);
  b.delivery = parameter_delivery::no_file;
  CHECK(b.why_not(b.set(R"({"gain":2})")).message.find("started by an earlier")
        != std::string::npos);
  b.delivery = parameter_delivery::too_long;
  CHECK(b.why_not(b.set(R"({"gain":2})")).message.find("60 KiB")
        != std::string::npos);
  CHECK(b.spec() == R"({"gain":1})");
}

TEST_CASE("a program that does not answer in time is put back when it does") {
  tuned_bench b;
  b.start_ready();
  const auto reply = b.set(R"({"gain":2})");
  b.advance(limits::instance::parameter_answer - 1s);
  b.alive();
  CHECK_FALSE(reply->has_value());
  b.advance(1s);
  CHECK(b.why_not(reply).code == error_code::timeout);
  CHECK(b.state() == instance_state::running);
  REQUIRE(b.ordered.size() == 1);
  b.taken(b.ordered[0].number);
  REQUIRE(b.ordered.size() == 2);
  CHECK(b.ordered[1].parameters == R"({"gain":1})");
  CHECK(b.ordered[1].number > b.ordered[0].number);
  b.taken(b.ordered[1].number);
  CHECK(b.ordered.size() == 2);
  CHECK(b.is_set(b.set(R"({"gain":1})")));
  CHECK(b.ordered.size() == 2);
}

TEST_CASE("an instance that ends meanwhile has not changed") {
  tuned_bench b;
  b.start_ready();
  const auto reply = b.set(R"({"gain":2})");
  b.exits(1);
  CHECK(b.why_not(reply).code == error_code::conflict);
  CHECK(b.spec() == R"({"gain":1})");
}

TEST_CASE("an instance that is to end takes no other parameters") {
  tuned_bench b;
  b.config.row.spec.life.safe_state = true;
  b.start_ready();
  b.stop();
  CHECK(b.why_not(b.set(R"({"gain":2})")).code == error_code::conflict);
  CHECK(b.ordered.empty());
}

TEST_CASE("a newer request takes the place of one without an answer") {
  tuned_bench b;
  b.start_ready();
  const auto first = b.set(R"({"gain":2})");
  const auto second = b.set(R"({"gain":3})");
  CHECK(b.why_not(first).code == error_code::conflict);
  REQUIRE(b.ordered.size() == 2);
  b.taken(b.ordered[0].number);
  CHECK_FALSE(second->has_value());
  b.taken(b.ordered[1].number);
  CHECK(b.is_set(second));
  CHECK(b.spec() == R"({"gain":3})");
}

TEST_CASE("one that is refused after another was taken is put back") {
  tuned_bench b;
  b.start_ready();
  b.set(R"({"gain":2})");
  b.set(R"({"gain":99})");
  b.taken(b.ordered[0].number);
  b.refused(b.ordered[1].number, "too loud");
  REQUIRE(b.ordered.size() == 3);
  CHECK(b.ordered[2].parameters == R"({"gain":1})");
}

TEST_CASE("of one that was adopted it is not known what it works with") {
  tuned_bench b;
  b.adopt_as(instance_state::running, {true, "c1", -1});
  const auto writes = b.store->records.size();
  const auto reply = b.set(R"({"gain":1})");
  REQUIRE(b.ordered.size() == 1);
  b.taken(b.ordered[0].number);
  CHECK(b.is_set(reply));
  CHECK(b.store->records.size() == writes);
  CHECK(b.is_set(b.set(R"({"gain":1})")));
  CHECK(b.ordered.size() == 1);
}

TEST_CASE("what an earlier run of the node has asked for is put back") {
  tuned_bench b;
  b.adopt_as(instance_state::running, {true, "c1", -1});
  b.taken(9'000'000'000'000);
  REQUIRE(b.ordered.size() == 1);
  CHECK(b.ordered[0].parameters == R"({"gain":1})");
  b.taken(b.ordered[0].number);
  CHECK(b.ordered.size() == 1);
}

TEST_CASE("what is set before a program is ready is ordered once it is") {
  tuned_bench b;
  b.start();
  CHECK(b.is_set(b.set(R"({"gain":2})")));
  CHECK(b.ordered.empty());
  b.ready();
  REQUIRE(b.ordered.size() == 1);
  CHECK(b.ordered[0].parameters == R"({"gain":2})");
}

TEST_CASE("a store that fails is no reason to forget what a program works "
          "with") {
  tuned_bench b;
  b.start_ready();
  const auto reply = b.set(R"({"gain":2})");
  b.store->error = fail(error_code::internal, "no room");
  b.taken(b.ordered[0].number);
  CHECK(b.is_set(reply));
  CHECK(b.spec() == R"({"gain":2})");
}

TEST_CASE("what is set while a program is being adopted is given to it then") {
  tuned_bench b;
  b.config.adopt = true;
  b.config.row.state = instance_state::running;
  b.config.row.container = "c1";
  b.runtime->adoption = {true, "c1", -1};
  b.instance = roscell::spawn(b.system, b.context, skill_instance, b.config);
  // Before it has begun.
  const auto reply = b.set(R"({"gain":2})");
  CHECK(b.is_set(reply));
  CHECK(b.ordered.empty());
  caf::anon_send(b.instance, start_instance{});
  b.settle();
  REQUIRE(b.ordered.size() == 1);
  CHECK(b.ordered[0].parameters == R"({"gain":2})");
}
