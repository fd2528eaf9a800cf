#include "skills/engine/life/heartbeat.hpp"

#include "roscell/skill/errors.hpp"

#include "test/skills/support.hpp"

#include <catch2/catch.hpp>

#include <cerrno>
#include <unistd.h>

using namespace roscell::engine;
using namespace roscell::test;
using namespace std::chrono_literals;
using Catch::Matchers::Contains;

TEST_CASE("states reach a socket of either kind of name") {
  temp_folder folder;
  auto abstract = "@roscell-test-" + std::to_string(::getpid());
  for (const auto& name : {folder / "notify", abstract}) {
    notify_receiver node{name};
    notify_socket skill{name};
    CHECK(skill.enabled());
    CHECK(skill.send("READY=1") == 0);
    CHECK(node.receive() == "READY=1");
  }
}

TEST_CASE("a skill without a node, or whose node restarts, carries on") {
  CHECK(notify_socket{""}.send("READY=1") == 0);
  CHECK_FALSE(notify_socket{""}.enabled());
  temp_folder folder;
  auto name = folder / "notify";
  notify_socket skill{name};
  CHECK(skill.send("READY=1") == ENOENT);
  {
    notify_receiver node{name};
    CHECK(skill.send("1") == 0);
  }
  CHECK(skill.send("2") == ECONNREFUSED);
  ::unlink(name.c_str());
  notify_receiver restarted{name};
  CHECK(skill.send("3") == 0);
  CHECK(restarted.receive() == "3");
}

TEST_CASE("a notify socket needs a usable name") {
  CHECK_THROWS_WITH(notify_socket{"relative"}, Contains("NOTIFY_SOCKET"));
  CHECK_THROWS_WITH(notify_socket{"/" + std::string(107, 'x')},
                    Contains("NOTIFY_SOCKET"));
  CHECK_THROWS_WITH(notify_socket{"@"}, Contains("NOTIFY_SOCKET"));
}

namespace {

/// A skill's words to its node, and the node.
struct heard_skill {
  temp_folder folder;
  notify_receiver node{folder / "notify"};
  notify_socket skill{folder / "notify"};
};

} // namespace

TEST_CASE_METHOD(
    heard_skill,
    "the heart beats with READY, WATCHDOG and now and then a status") {
  liveness alive{20ms};
  safe_state untold;
  heartbeat sender{
      skill, alive, untold, {[] { return "STATUS=frames=1"; }, nullptr}};
  CHECK(node.receive() == "READY=1\nWATCHDOG=1");
  CHECK(node.receive() == "READY=1\nWATCHDOG=1");
  CHECK(node.wait_for("STATUS") == "READY=1\nWATCHDOG=1\nSTATUS=frames=1");
}

TEST_CASE_METHOD(
    heard_skill,
    "the heart stands still while work hangs, and makes up for it") {
  liveness alive{20ms};
  // Work that began an hour ago hangs, whatever the machine's speed.
  alive.work_begins(liveness::clock::now() - 1h);
  CHECK_FALSE(alive.allows_heartbeat(liveness::clock::now()));
  safe_state untold;
  heartbeat sender{skill, alive, untold, {[] { return ""; }, nullptr}};
  // Ten periods of the timer that would have sent a heartbeat.
  stop_event never;
  CHECK_FALSE(never.wait_until(liveness::clock::now() + 100ms));
  CHECK_FALSE(node.receive_now());
  CHECK(alive.work_ends());
  sender.send_now();
  CHECK(node.receive() == "READY=1\nWATCHDOG=1");
}

namespace {

/// A heart that hardly beats, with a node that hears it.
struct quiet_heart : heard_skill {
  liveness alive{1h};
  safe_state safety;
  heartbeat sender{skill, alive, safety, {[] { return ""; }, nullptr}};
};

} // namespace

TEST_CASE_METHOD(quiet_heart, "a word on safety is told at once") {
  safety.set(false);
  CHECK(node.receive() == "ROSCELL_SAFE=0");
  safety.set(true);
  CHECK(node.receive() == "ROSCELL_SAFE=1");
}

TEST_CASE_METHOD(quiet_heart, "a word on safety that says nothing new is not "
                              "told") {
  safety.set(true);
  safety.set(true);
  safety.set(true);
  CHECK(node.receive() == "ROSCELL_SAFE=1");
  safety.set(false);
  CHECK(node.receive() == "ROSCELL_SAFE=0");
}

TEST_CASE_METHOD(quiet_heart, "a skill that changes its mind a thousand times "
                              "sends a few words, and its last one") {
  const auto begin = liveness::clock::now();
  for (int i = 0; i < 1000; ++i) {
    safety.set(i % 2 == 0);
    safety.set(i % 2 != 0);
    std::this_thread::yield();
  }
  safety.set(false);
  safety.set(true);
  std::size_t words = 0;
  std::string last;
  while (auto word = node.receive_now()) {
    ++words;
    last = *word;
  }
  const auto span = liveness::clock::now() - begin;
  CHECK(words
        <= static_cast<std::size_t>(span / heartbeat::least_word_pause) + 1);
  // Only what is said now can follow.
  if (last != "ROSCELL_SAFE=1")
    CHECK(node.wait_for("ROSCELL_SAFE=1"));
}

TEST_CASE_METHOD(
    heard_skill,
    "every heartbeat repeats the word on safety, for a node that was "
    "restarted") {
  liveness alive{20ms};
  safe_state safety;
  safety.set(false);
  heartbeat sender{skill, alive, safety, {[] { return ""; }, nullptr}};
  for (int i = 0; i < 3; ++i)
    CHECK(node.wait_for("WATCHDOG") == "READY=1\nWATCHDOG=1\nROSCELL_SAFE=0");
}

TEST_CASE_METHOD(heard_skill, "a word on safety is told while work hangs") {
  liveness alive{20ms};
  alive.work_begins(liveness::clock::now() - 1h);
  safe_state safety;
  heartbeat sender{skill, alive, safety, {[] { return ""; }, nullptr}};
  safety.set(false);
  CHECK(node.receive() == "ROSCELL_SAFE=0");
}

TEST_CASE_METHOD(
    heard_skill,
    "a heart that tells of streams sends a heartbeat every second or faster") {
  liveness alive{1h};
  safe_state untold;
  const auto begin = liveness::clock::now();
  heartbeat sender{
      skill,
      alive,
      untold,
      {[] { return "STATUS=s"; }, [](auto) { return "input:0 1 0"; }}};
  CHECK(node.receive()
        == "READY=1\nWATCHDOG=1\nROSCELL_STREAMS=input:0 1 0\nSTATUS=s");
  CHECK(liveness::clock::now() - begin < 5s);
}
