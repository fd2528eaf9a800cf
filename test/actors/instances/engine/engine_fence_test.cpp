#include "actors/edge/process/fence_file.hpp"
#include "test/actors/instances/engine/engine_bench.hpp"

#include <string>

using namespace roscell;
using namespace roscell::test;
namespace fs = std::filesystem;

namespace {

constexpr int64_t moment = 3'600'000;

/// The bench with a container that has a fence.
struct fenced_bench : engine_bench {
  fenced_bench() {
    script.on("POST /containers/create",
              [this](engine_caller& who, const engine_call_seen& what) {
                mounts = json::parse(what.body)["HostConfig"]["Mounts"];
                who.reply(201, R"({"Id":"c1"})");
              });
    script.on("POST /containers/c1/start", 204, "");
    order = container();
    order.fence_boot_ms = moment;
  }

  ~fenced_bench() {
    remove_fence(file());
  }

  /// The host's file that the container sees.
  fs::path file() const {
    return mounts.size() > 3 ? mounts[3]["Source"].get<std::string>() : "";
  }

  void move(const std::string& container, int64_t boot_ms) {
    caf::anon_send(runtime, fence_container{"i", container, boot_ms});
    // It has been done when the next one is answered.
    ask<actor_state>(state_query{});
  }

  json mounts = json::array();
  start_container order;
};

} // namespace

TEST_CASE("a container's fence is there before it is, and goes with it") {
  fenced_bench b;
  b.get<container_started>(b.order);
  const fs::path shim = b.mounts[1]["Source"].get<std::string>();
  CHECK(shim.parent_path() == b.config.data_dir);
  CHECK(fs::file_size(shim) == fs::file_size(b.config.shim));
  CHECK((fs::status(shim).permissions() & fs::perms::others_exec)
        != fs::perms::none);
  CHECK(fence_in(b.file()) == moment);
  b.script.on("DELETE /containers/c1", 204, "");
  b.get<container_removed>(remove_container{"i", "c1"});
  CHECK_FALSE(fs::exists(b.file()));
}

TEST_CASE("a container's fence is moved on, by its own orders only") {
  fenced_bench b;
  b.get<container_started>(b.order);
  b.move("other", moment + 1);
  CHECK(fence_in(b.file()) == moment);
  b.move("c1", moment + 2);
  CHECK(fence_in(b.file()) == moment + 2);
  b.move("c1", moment + 1);
  CHECK(fence_in(b.file()) == moment + 2);
  // Whether its engine can be asked or not.
  b.engine = nullptr;
  b.reported.await("trouble");
  b.move("c1", moment + 3);
  CHECK(fence_in(b.file()) == moment + 3);
}

TEST_CASE("a node that was restarted moves the fence on of a container") {
  fenced_bench b;
  b.get<container_started>(b.order);
  end_and_await(b.self, b.runtime);
  b.begin_runtime();
  b.move("c1", moment + 1);
  CHECK(fence_in(b.file()) == moment);
  b.script.on("GET /containers/c1/json", 200,
              R"({"Id":"c1","State":{"Running":true}})");
  CHECK(b.get<container_adopted>(adopt_container{"i", "c1"}).running);
  b.move("c1", moment + 2);
  CHECK(fence_in(b.file()) == moment + 2);
}

TEST_CASE("a container's fence that cannot be moved on is told") {
  fenced_bench b;
  b.get<container_started>(b.order);
  remove_fence(b.file());
  b.move("c1", moment + 1);
  b.reported_events.await("fence_failed i");
}

TEST_CASE("without a shim nothing is started") {
  fenced_bench b;
  b.config.shim = "/no/such/shim";
  end_and_await(b.self, b.runtime);
  b.begin_runtime();
  const auto why = b.refusal<container_started>(b.order);
  CHECK(why.message.find("/no/such/shim") != std::string::npos);
  CHECK_FALSE(why.hint.empty());
}

TEST_CASE("a container that is to be stop-safe is told by SIGUSR1") {
  engine_bench b;
  b.will_start();
  b.get<container_started>(b.container());
  caf::anon_send(b.runtime, ask_for_safety{"i", "other"});
  SECTION("it hears") {
    b.script.on("POST /containers/c1/kill?signal=SIGUSR1", 204, "");
    caf::anon_send(b.runtime, ask_for_safety{"i", "c1"});
    b.script.calls().await("POST /containers/c1/kill?signal=SIGUSR1");
  }
  SECTION("it does not") {
    b.script.on("POST /containers/c1/kill", 409, R"({"message":"paused"})");
    caf::anon_send(b.runtime, ask_for_safety{"i", "c1"});
    b.reported_events.await("safety_not_asked i");
  }
}
