#include "actors/edge/process/fence_file.hpp"
#include "actors/edge/process/process_identity.hpp"
#include "test/actors/instances/process/process_bench.hpp"

#include <poll.h>

#include <string>

using namespace roscell;
using namespace roscell::test;
namespace fs = std::filesystem;

namespace {

/// Long enough for a busy machine to start a program.
constexpr int64_t soon_ms = 2'000;

constexpr int64_t hour_ms = 3'600'000;

fs::path fence_of(const process_bench& b) {
  return fence_path(b.config.instances_dir / "i");
}

} // namespace

TEST_CASE("a program ends when its fence passes, though its node is gone") {
  process_bench b;
  const auto container = b.start(endless, "i", boot_now_ms(b.system) + soon_ms);
  const unique_fd shim{::pidfd_open(std::stoi(container), 0)};
  b.leave();
  pollfd ended{shim.get(), POLLIN, 0};
  REQUIRE(::poll(&ended, 1, 30'000) == 1);
  b.restart();
  const auto adopted =
      b.get<container_adopted>(adopt_container{"i", container});
  CHECK_FALSE(adopted.running);
  CHECK(adopted.exit_code == 137);
}

TEST_CASE("a node that was restarted moves the fence on of what it adopts") {
  process_bench b;
  const auto first = boot_now_ms(b.system) + soon_ms;
  const auto container = b.start(endless, "i", first);
  b.restart();
  CHECK(b.get<container_adopted>(adopt_container{"i", container}).running);
  caf::anon_send(b.runtime, fence_container{"i", container, first + 1'000});
  // An order that was late.
  caf::anon_send(b.runtime, fence_container{"i", container, first});
  CHECK(b.reported.take() == "exit 137");
  CHECK(boot_now_ms(b.system) >= first + 1'000);
}

TEST_CASE("an order for an older container moves no fence on") {
  process_bench b;
  const auto first = boot_now_ms(b.system) + hour_ms;
  const auto container = b.start(endless, "i", first);
  caf::anon_send(b.runtime, fence_container{"i", "1:1", first + 1});
  caf::anon_send(b.runtime, fence_container{"nobody", "1:1", first + 1});
  caf::anon_send(b.runtime, hear_container{"i"});
  b.reported.await("heard");
  CHECK(fence_in(fence_of(b)) == first);
  caf::anon_send(b.runtime, fence_container{"i", container, first + 1});
  caf::anon_send(b.runtime, hear_container{"i"});
  b.reported.await("heard");
  CHECK(fence_in(fence_of(b)) == first + 1);
}

TEST_CASE("a fence that cannot be moved on is told, once") {
  process_bench b;
  const auto first = boot_now_ms(b.system) + hour_ms;
  const auto one = b.start("echo up; " + endless, "i", first);
  const auto other = b.start("echo up; " + endless, "j", first);
  // Their shims have opened the fences by then.
  for (const auto* instance : {"i", "j"})
    REQUIRE(b.log(0, 30'000, instance).text == "up\n");
  const auto move = [&](const std::string& instance,
                        const std::string& container) {
    caf::anon_send(b.runtime,
                   fence_container{instance, container, first + 1'000});
  };
  remove_fence(fence_of(b));
  move("i", one);
  move("i", one);
  remove_fence(fence_path(b.config.instances_dir / "j"));
  move("j", other);
  CHECK(b.reported_events.take() == "fence_failed i");
  CHECK(b.reported_events.take() == "fence_failed j");
  // When it has succeeded meanwhile it is told again.
  REQUIRE_FALSE(make_fence(fence_of(b), first));
  move("i", one);
  caf::anon_send(b.runtime, hear_container{"i"});
  b.reported.await("heard");
  remove_fence(fence_of(b));
  move("i", one);
  CHECK(b.reported_events.take() == "fence_failed i");
}

TEST_CASE("an instance that is removed leaves no fence") {
  process_bench b;
  b.start(endless, "i", boot_now_ms(b.system) + hour_ms);
  CHECK(fs::exists(fence_of(b)));
  b.get<container_removed>(remove_container{"i", {}});
  CHECK_FALSE(fs::exists(fence_of(b)));
}

TEST_CASE("a stray that is removed leaves no fence") {
  process_bench b;
  b.start(endless, "i", boot_now_ms(b.system) + hour_ms);
  b.restart();
  b.get<container_removed>(remove_container{"i", {}});
  CHECK_FALSE(fs::exists(fence_of(b)));
}

TEST_CASE("what may not go on any more is not started") {
  process_bench b;
  b.instances.push_back("i");
  b.folder.write("skill/bin/run", "#!/bin/sh\n", true);
  start_container order;
  order.instance = "i";
  order.image = b.folder.path() / "skill";
  order.command = {"bin/run"};
  order.fence_boot_ms = 1;
  const auto answer = b.ask<container_started>(order);
  REQUIRE_FALSE(answer);
  const auto why = to_failure(answer.error());
  CHECK(why.code == error_code::engine_failed);
  CHECK(why.message.find("cannot keep the fence") != std::string::npos);
}

TEST_CASE("who is to be stop-safe is told by SIGUSR1") {
  process_bench b;
  const auto container = b.start("trap 'exit 8' USR1; echo up; " + endless);
  CHECK(b.log(0, 20'000).text == "up\n");
  caf::anon_send(b.runtime, ask_for_safety{"i", "1:1"});
  caf::anon_send(b.runtime, hear_container{"i"});
  b.reported.await("heard");
  CHECK(b.get<container_adopted>(adopt_container{"i", container}).running);
  caf::anon_send(b.runtime, ask_for_safety{"i", container});
  CHECK(b.reported.take() == "exit 8");
}
