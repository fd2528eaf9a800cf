#include "messages/failure.hpp"
#include "test/actors/fakes/instance_bench.hpp"

#include <string>
#include <vector>

using namespace roscell;
using namespace roscell::test;
using namespace std::chrono_literals;

namespace {

/// An instance whose step names two secrets, beside a keeper that does what the
/// test says.
struct secret_bench : instance_bench {
  secret_bench() {
    config.secrets = caf::actor_cast<secret_keeper_actor>(
        system.spawn([this]() -> caf::behavior {
          return {[this](const lay_out_secrets& x)
                      -> caf::result<secrets_laid_out> {
                    asked.push_back(x);
                    if (refusal)
                      return refusal;
                    return given;
                  },
                  [this](const clear_secrets& x) {
                    cleared.push_back(x.instance);
                  }};
        }));
    auto& spec = config.row.spec;
    spec.secrets = {"key"};
    spec.secret_env = {{"PASSWORD", "pass"}};
    spec.life.restart.policy = restart_when::on_failure;
    given = {"/memory/i", {"hidden"}};
  }

  ~secret_bench() {
    kill(config.secrets);
  }

  caf::error refusal;
  secrets_laid_out given;
  std::vector<lay_out_secrets> asked;
  std::vector<std::string> cleared;
};

bool is_hidden(const std::string& text) {
  return text.find("hidden") == std::string::npos;
}

using words = std::vector<std::string>;

} // namespace

TEST_CASE("a program finds its secrets, and nothing else has their values",
          "[secrets]") {
  secret_bench b;
  b.start_ready();
  REQUIRE(b.asked.size() == 1);
  CHECK(b.asked[0].instance == "i");
  CHECK(b.asked[0].files == words{"key"});
  CHECK(b.asked[0].variables == words{"pass"});
  REQUIRE(b.runtime->started.size() == 1);
  const auto& started = b.runtime->started[0];
  CHECK(started.environment.at("PASSWORD") == "hidden");
  CHECK(started.environment.at("ROSCELL_SECRETS") == "/memory/i");
  CHECK(started.secrets_folder == "/memory/i");
  for (const auto& row : b.reported->rows)
    CHECK(is_hidden(json(row).dump()));
  for (const auto& record : b.store->records)
    CHECK(is_hidden(record.value));
  auto state = b.ask<actor_state>(b.instance, state_query{});
  b.settle();
  CHECK(is_hidden((*state)->value().json_text));
}

TEST_CASE("an instance without secrets asks for none", "[secrets]") {
  secret_bench b;
  b.config.row.spec.secrets.clear();
  b.config.row.spec.secret_env.clear();
  b.start_ready();
  CHECK(b.asked.empty());
  CHECK(b.runtime->started[0].environment.count("ROSCELL_SECRETS") == 0);
  b.exits(0);
  CHECK(b.cleared.empty());
}

TEST_CASE("secrets are laid out anew with each start, and go with each end",
          "[secrets]") {
  secret_bench b;
  b.start_ready();
  b.exits(1);
  CHECK(b.cleared == words{"i"});
  CHECK(b.state() == instance_state::backing_off);
  b.given.values = {"hidden2"};
  b.advance(10s);
  REQUIRE(b.runtime->started.size() == 2);
  CHECK(b.runtime->started[1].environment.at("PASSWORD") == "hidden2");
  b.ready();
  b.stop();
  CHECK(b.cleared == words{"i", "i"});
}

TEST_CASE("an instance whose secret is gone waits, and says what sets it",
          "[secrets]") {
  secret_bench b;
  b.start_ready();
  b.refusal = fail(error_code::conflict, "node 'n' has no secret 'key'",
                   "/name", "`roscell secret set key` there");
  b.exits(1);
  b.advance(5s);
  CHECK(b.asked.size() > 1);
  CHECK(b.state() == instance_state::backing_off);
  CHECK(b.reason()
        == "node 'n' has no secret 'key' (`roscell secret set key` there)");
  CHECK(b.runtime->started.size() == 1);
  b.refusal = {};
  b.advance(10s);
  REQUIRE(b.runtime->started.size() == 2);
  b.ready();
  CHECK(b.state() == instance_state::running);
}

TEST_CASE("an instance that was never ready fails without its secret",
          "[secrets]") {
  secret_bench b;
  b.refusal = fail(error_code::conflict, "node 'n' has no secret 'key'");
  b.start();
  CHECK(b.state() == instance_state::failed);
  CHECK(b.runtime->started.empty());
}

TEST_CASE("a program that an earlier run has started keeps its secrets",
          "[secrets]") {
  secret_bench b;
  b.adopt_as(instance_state::running, {true, "c1"});
  CHECK(b.state() == instance_state::running);
  CHECK(b.asked.empty());
  CHECK(b.cleared.empty());
}

TEST_CASE("secrets of an instance that is stopped meanwhile do not stay",
          "[secrets]") {
  secret_bench b;
  b.runtime->prepare_error = fail(error_code::engine_failed, "no image");
  b.start();
  CHECK(b.state() == instance_state::failed);
  CHECK(b.cleared == words{"i"});
}
