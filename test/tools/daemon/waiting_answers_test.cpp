#include "tools/roscell/daemon/waiting_answers.hpp"

#include "messages/failure.hpp"
#include "test/actors/edge/process/supervision_fixture.hpp"
#include "tools/roscell/client/node_client.hpp"
#include "tools/roscell/exit_code.hpp"

#include <catch2/catch.hpp>

#include <filesystem>

using namespace roscell;
using namespace roscell::cli;
using namespace roscell::test;
using Catch::Matchers::Contains;

namespace {

struct waiting_bench {
  waiting_bench() {
    config.data_dir = folder.path() / "node";
    config.socket = config.data_dir / "node.sock";
  }

  node_client client() const {
    return node_client{{config.socket.string(), {}}};
  }

  failure answer(const std::string& path) const {
    try {
      client().get(path);
    } catch (const refused& why) {
      return failure_from(why.reply);
    }
    return {};
  }

  temp_folder folder;
  node_config config;
};

} // namespace

TEST_CASE("whoever asks a node that waits is told what it waits for",
          "[tools]") {
  waiting_bench b;
  {
    waiting_answers answers{b.config};
    answers.set_missing("interface 'eth0' is down");
    const auto why = b.answer("/v1/node");
    CHECK(why.code == error_code::conflict);
    CHECK(why.message
          == "the node waits for its interface: interface 'eth0' is down");
    CHECK_THAT(why.hint, Contains("SIGTERM"));
    answers.set_missing("interface 'eth0' has no IPv4 address");
    CHECK_THAT(b.answer("/v1/hello").message, Contains("no IPv4 address"));
    const auto reply =
        b.client().post("/v1/requests", "{}", std::chrono::seconds{20});
    CHECK(failure_from(reply).code == error_code::conflict);
    CHECK(b.client().get("/healthz").at("status") == "ok");
  }
  CHECK_FALSE(std::filesystem::exists(b.config.socket));
}

TEST_CASE("a second node of the same data directory does not wait", "[tools]") {
  waiting_bench b;
  const waiting_answers first{b.config};
  CHECK_THROWS_WITH(waiting_answers{b.config},
                    Contains("is in use by another node"));
}
