#include "actors/core/answer_limits.hpp"
#include "actors/edge/engine/program_libraries.hpp"
#include "actors/edge/history/kept_log_folder.hpp"
#include "actors/edge/limits.hpp"
#include "actors/edge/process/notify_socket.hpp"
#include "test/actors/instances/engine/engine_bench.hpp"

#include <atomic>
#include <cstdlib>
#include <fstream>

using namespace roscell;
using namespace roscell::test;

namespace {

constexpr const char* running =
    R"({"Id":"c1","Created":"2026-11-21T20:54:31Z",)"
    R"("State":{"Status":"running","Running":true,"ExitCode":0}})";
constexpr const char* ended =
    R"({"Id":"c1","Created":"2026-11-21T20:54:31Z",)"
    R"("State":{"Status":"exited","Running":false,"ExitCode":6}})";

std::string log_line(const std::string& text) {
  const auto payload = "2026-11-21T20:54:32.000000100Z " + text + "\n";
  return std::string{1, 0, 0, 0, 0, 0, 0, static_cast<char>(payload.size())}
         + payload;
}

} // namespace

TEST_CASE("a started container's exit is told once, with its code") {
  engine_bench b;
  b.will_start();
  CHECK(b.get<container_started>(b.container()).container == "c1");
  b.script.publish_transfer_end("i", "other", 1);
  b.script.publish_transfer_end("i", "c1", 3);
  CHECK(b.reported.take() == "exit c1 3");
}

TEST_CASE("a container that its engine has ended for memory is told as such") {
  constexpr const char* out_of_memory =
      R"({"Id":"c1","State":{"Running":false,"ExitCode":137,"OOMKilled":true}})";
  engine_bench b;
  SECTION("while the node is there") {
    b.will_start();
    b.get<container_started>(b.container());
    b.script.on("GET /containers/c1/json", 200, out_of_memory);
    b.script.publish_transfer_end("i", "c1", 137);
    CHECK(b.reported.take() == "exit c1 137, memory");
  }
  SECTION("while it was away") {
    b.script.on("GET /containers/roscell-i/json", 200, out_of_memory);
    const auto x = b.get<container_adopted>(adopt_container{"i", {}});
    CHECK_FALSE(x.running);
    CHECK(x.cause == end_cause::memory);
  }
  SECTION("which it has survived") {
    b.will_start();
    b.get<container_started>(b.container());
    b.script.on("GET /containers/c1/json", 200, out_of_memory);
    b.script.publish_transfer_end("i", "c1", 0);
    CHECK(b.reported.take() == "exit c1 0");
  }
}

TEST_CASE("an end before the engine's answer is told after it") {
  engine_bench b;
  b.script.on("POST /containers/create", 201, R"({"Id":"c1"})");
  b.script.on("POST /containers/c1/start",
              [&](engine_caller& who, const engine_call_seen&) {
                b.script.publish_transfer_end("i", "c1", 127);
                who.reply(204, "");
              });
  CHECK(b.get<container_started>(b.container()).container == "c1");
  CHECK(b.reported.take() == "exit c1 127");
}

TEST_CASE("a container that cannot be started is removed, and why is told") {
  engine_bench b;
  b.script.on("POST /containers/create", 201, R"({"Id":"c1"})");
  b.script.on("POST /containers/c1/start", 400,
              R"({"message":"exec: no such file"})");
  b.script.on("DELETE /containers/c1", 204, "");
  const auto why = b.refusal<container_started>(b.container());
  CHECK(why.code == error_code::engine_failed);
  CHECK(why.message.find("exec: no such file") != std::string::npos);
  b.script.calls().await("DELETE /containers/c1?force=true&v=true");
}

TEST_CASE("an ended container makes room, a running one does not") {
  engine_bench b;
  int attempts = 0;
  b.script.on("POST /containers/create",
              [&](engine_caller& who, const engine_call_seen&) {
                if (++attempts == 1)
                  who.reply(409, R"({"message":"name in use"})");
                else
                  who.reply(201, R"({"Id":"c1"})");
              });
  b.script.on("POST /containers/c1/start", 204, "");
  SECTION("ended") {
    b.script.on("GET /containers/roscell-i/json", 200, ended);
    b.script.on("DELETE /containers/roscell-i", 204, "");
    CHECK(b.get<container_started>(b.container()).container == "c1");
  }
  SECTION("running") {
    b.script.on("GET /containers/roscell-i/json", 200, running);
    CHECK(
        b.refusal<container_started>(b.container()).message.find("runs already")
        != std::string::npos);
  }
}

TEST_CASE("an image that is there is taken at once") {
  engine_bench b;
  b.script.on("GET /images/roscell/echo:", 200);
  const auto one = b.get<image_prepared>(b.image());
  CHECK(one.image.rfind("roscell/echo:", 0) == 0);
  CHECK(b.get<image_prepared>(b.image("j")).image == one.image);
}

TEST_CASE("two who want the same image share one build") {
  engine_bench b;
  std::atomic<int> builds{0};
  std::atomic<bool> built{false};
  b.script.on("GET /images/roscell/echo:",
              [&](engine_caller& who, const engine_call_seen&) {
                who.reply(built ? 200 : 404, "{}");
              });
  event_inbox waiting;
  b.script.on("POST /build",
              [&](engine_caller& who, const engine_call_seen& what) {
                CHECK(what.body.find("FROM base:1") != std::string::npos);
                ++builds;
                // The second request is there before the first is done.
                waiting.take();
                built = true;
                who.open();
                who.chunk("{\"stream\":\"Step 1/5 : FROM base:1\"}\n");
                who.end();
              });
  auto first = b.self->request(b.runtime, patience, b.image("i"));
  auto second = b.self->request(b.runtime, patience, b.image("j"));
  // Answered after both requests were taken in.
  b.ask<actor_state>(state_query{});
  waiting.put("both are there");
  std::string images[2];
  const auto fail_with = [](caf::error& why) { FAIL(to_failure(why).message); };
  first.receive([&](image_prepared& x) { images[0] = x.image; }, fail_with);
  second.receive([&](image_prepared& x) { images[1] = x.image; }, fail_with);
  CHECK(images[0] == images[1]);
  CHECK(builds == 1);
  CHECK(b.reported.take() == "says Step 1/5 : FROM base:1");
  CHECK(std::filesystem::is_empty(b.config.data_dir / "build"));
}

TEST_CASE("a failed build is told in the engine's words, with its log") {
  engine_bench b;
  b.script.on("POST /build", [](engine_caller& who, const engine_call_seen&) {
    who.open();
    who.chunk("{\"stream\":\"Step 1/5 : FROM base:1\"}\n"
              "{\"stream\":\"Step 2/5 : COPY opt /opt\"}\n"
              "no JSON\n[1]\n{\"stream\":7}\n"
              "{\"error\":\"no space left on device\"}\n");
    who.end();
  });
  const auto why = b.refusal<image_prepared>(b.image());
  CHECK(why.code == error_code::engine_failed);
  CHECK(why.message.find("no space left on device") != std::string::npos);
  CHECK(why.hint.find("free space") != std::string::npos);
  CHECK(why.details.find("COPY opt /opt") != std::string::npos);
}

TEST_CASE("an engine that goes away in a build is told, and the image not") {
  engine_bench b;
  b.script.on("POST /build", [](engine_caller& who, const engine_call_seen&) {
    who.open();
    who.chunk("{\"stream\":\"Step 1/5 : FROM base:1\"}\n");
    who.hang_up();
  });
  CHECK(b.refusal<image_prepared>(b.image()).message.find("went away")
        != std::string::npos);
}

TEST_CASE("what makes an image ends with the runtime") {
  engine_bench b;
  event_inbox asked;
  b.script.on("POST /build", [&](engine_caller&, const engine_call_seen&) {
    asked.put("build"); // Never answered.
  });
  caf::anon_send(b.runtime, b.image());
  asked.take();
  // The actor system of the bench waits for every actor.
  b.self->monitor(b.runtime);
  caf::anon_send_exit(b.runtime, caf::exit_reason::user_shutdown);
  b.self->receive([](const caf::down_msg&) {});
}

TEST_CASE("what is adopted is watched, what has ended is told") {
  engine_bench b;
  SECTION("it runs") {
    b.script.on("GET /containers/c1/json", 200, running);
    CHECK(b.get<container_adopted>(adopt_container{"i", "c1"}).running);
    CHECK(b.get<container_adopted>(adopt_container{"i", {}}).container == "c1");
    b.script.publish_transfer_end("i", "c1", 9);
    CHECK(b.reported.take() == "exit c1 9");
  }
  SECTION("it has ended") {
    b.script.on("GET /containers/roscell-i/json", 200, ended);
    const auto x = b.get<container_adopted>(adopt_container{"i", {}});
    CHECK_FALSE(x.running);
    CHECK(x.container == "c1");
    CHECK(x.exit_code == 6);
  }
  SECTION("there is none") {
    const auto x = b.get<container_adopted>(adopt_container{"i", {}});
    CHECK_FALSE(x.running);
    CHECK(x.container.empty());
  }
}

TEST_CASE("an engine that is lost is told, and what happened meanwhile too") {
  engine_bench b;
  b.will_start();
  b.get<container_started>(b.container());
  b.engine = nullptr;
  CHECK(b.reported.take() == "trouble");
  // Nothing is known, so nothing is said to be gone.
  CHECK_FALSE(b.ask<container_stopped>(stop_container{"i", "c1", 0}));
  CHECK_FALSE(b.ask<container_removed>(remove_container{"i", "c1"}));
  CHECK_FALSE(b.ask<image_prepared>(b.image()));
  b.script.on("GET /containers/c1/json", 200, ended);
  b.begin_engine();
  CHECK(b.reported.take() == "no trouble");
  CHECK(b.reported.take() == "exit c1 6");
  // What could not be ended then must not go on now.
  b.script.calls().await("DELETE /containers/roscell-i?force=true&v=true");
}

TEST_CASE("an engine that goes away in a start leaves nothing running") {
  engine_bench b;
  b.script.on("POST /containers/create", 201, R"({"Id":"c1"})");
  b.script.on(
      "POST /containers/c1/start",
      [](engine_caller& who, const engine_call_seen&) { who.hang_up(); });
  const auto why = b.refusal<container_started>(b.container());
  CHECK(why.code == error_code::engine_failed);
  CHECK(why.message.find("went away") != std::string::npos);
  b.engine = nullptr;
  b.reported.await("trouble");
  b.begin_engine();
  b.script.calls().await("DELETE /containers/roscell-i?force=true&v=true");
}

TEST_CASE("an adoption waits for an engine that is not there yet") {
  engine_bench b;
  b.engine = nullptr;
  b.reported.await("trouble");
  b.script.on("GET /containers/c1/json", 200, running);
  auto adoption =
      b.self->request(b.runtime, patience, adopt_container{"i", "c1"});
  b.begin_engine();
  adoption.receive([](container_adopted& x) { CHECK(x.running); },
                   [](caf::error& why) { FAIL(to_failure(why).message); });
}

TEST_CASE("stopping gives the grace to the engine and tells the exit code") {
  engine_bench b;
  b.will_start();
  b.get<container_started>(b.container());
  // By which its program can be told of another address.
  CHECK(std::filesystem::is_fifo(
      environment_file_of(container_notify_path(b.config.data_dir, "i"))));
  b.script.on("POST /containers/c1/stop?t=2", 204, "");
  b.script.on("GET /containers/c1/json", 200, ended);
  CHECK(b.get<container_stopped>(stop_container{"i", "c1", 1500}).exit_code
        == 6);
  b.script.on("DELETE /containers/c1", 204, "");
  b.get<container_removed>(remove_container{"i", "c1"});
  CHECK(std::filesystem::is_empty(b.config.data_dir / "notify"));
  // Neither fails for a container that is gone.
  b.get<container_stopped>(stop_container{"i", {}, 0});
  b.get<container_removed>(remove_container{"i", {}});
}

TEST_CASE("a container that is being ended politely can be ended by force") {
  engine_bench b;
  b.will_start();
  b.get<container_started>(b.container());
  b.script.on("POST /containers/c1/stop?t=5",
              [](engine_caller&, const engine_call_seen&) {
                // It waits for its end, as long as it takes.
              });
  b.script.on("POST /containers/c1/kill?signal=KILL", 204, "");
  b.script.on("POST /containers/c1/stop?t=0", 304, "");
  b.script.on("GET /containers/c1/json", 200, ended);
  caf::anon_send(b.runtime, stop_container{"i", "c1", 5000});
  b.script.calls().await("POST /containers/c1/stop?t=5");
  CHECK(b.get<container_stopped>(stop_container{"i", "c1", 0}).exit_code == 6);
  b.script.calls().await("POST /containers/c1/kill?signal=KILL");
}

namespace {

/// A skill whose program needs a library that is found in a folder of the test.
struct linked_skill {
  linked_skill() {
    const std::filesystem::path program{"/bin/ls"};
    const auto needed = find_libraries("/nowhere", program);
    for (const auto& x : std::get<std::vector<shared_library>>(needed))
      std::filesystem::copy_file(x.file, library = libraries.path() / x.name);
    REQUIRE_FALSE(library.empty());
    const auto run = b.folder.path() / "skill/bin/run";
    std::filesystem::remove(run);
    std::filesystem::copy_file(program, run);
    ::setenv("LD_LIBRARY_PATH", libraries.path().c_str(), 1);
    // Every image is there.
    b.script.on("GET /images/", 200);
  }

  ~linked_skill() {
    ::unsetenv("LD_LIBRARY_PATH");
  }

  std::string image() {
    return b.get<image_prepared>(b.image()).image;
  }

  temp_folder libraries;
  std::filesystem::path library;
  engine_bench b;
};

} // namespace

TEST_CASE("a library of the host that is upgraded makes another image") {
  linked_skill skill;
  const auto before = skill.image();
  CHECK(skill.image() == before);
  std::ofstream{skill.library, std::ios::app} << "newer";
  const auto after = skill.image();
  CHECK(after != before);
  CHECK(skill.image() == after);
}

TEST_CASE("the log of a container that goes is kept before") {
  engine_bench b;
  b.config.kept_logs = b.folder.path() / "history";
  end_and_await(b.self, b.runtime);
  b.begin_runtime();
  const kept_log_folder kept{b.config.kept_logs};
  kept_log about;
  about.instance = "i";
  about.ended_unix_ms = 1000;
  b.script.on("DELETE /containers/c1", 204, "");
  SECTION("with what it has said") {
    b.script.on("GET /containers/c1/logs", 200, log_line("last"));
    b.get<container_removed>(remove_container{"i", "c1", false, {about}});
    REQUIRE(kept.newest_of("i"));
    const auto part = kept.newest_of("i")->read_from(0, true);
    CHECK(part.text == "last\n");
    CHECK(part.ended);
    REQUIRE(part.times_unix_ms.size() == 1);
    CHECK(part.times_unix_ms[0] > 0);
  }
  SECTION("though it has said nothing") {
    b.script.on("GET /containers/c1/logs", 200, "");
    b.get<container_removed>(remove_container{"i", "c1", true, {about}});
    CHECK(kept.list({}).logs.size() == 1);
  }
  SECTION("but it goes whether its log can be read or not") {
    b.script.on("GET /containers/c1/logs", 500, "{}");
    b.get<container_removed>(remove_container{"i", "c1", false, {about}});
    CHECK(kept.list({}).logs.empty());
  }
  b.script.calls().await("DELETE /containers/c1?force=true&v=true");
}

TEST_CASE("a container is adopted though another one is on record") {
  engine_bench b;
  b.script.on("GET /containers/roscell-i/json", 200, running);
  const auto adopted = b.get<container_adopted>(adopt_container{"i", "c0"});
  CHECK(adopted.running);
  CHECK(adopted.container == "c1");
}

TEST_CASE("a log is read, and followed until there is more") {
  engine_bench b;
  log_query query;
  query.instance = "i";
  query.offset = 0;
  SECTION("of an ended container it ends") {
    b.script.on("GET /containers/roscell-i/json", 200, ended);
    b.script.on("GET /containers/c1/logs", 200, log_line("last"));
    auto x = b.get<log_excerpt>(query);
    CHECK(x.text == "last\n");
    CHECK(x.ended);
    query.offset = x.next_offset;
    x = b.get<log_excerpt>(query);
    CHECK(x.text.empty());
    CHECK(x.ended);
    CHECK(x.next_offset == query.offset);
  }
  SECTION("of a running one it waits") {
    query.wait_ms = 20'000;
    b.script.on("GET /containers/roscell-i/json", 200, running);
    b.script.on("GET /containers/c1/logs",
                [](engine_caller& who, const engine_call_seen& what) {
                  CHECK(what.target.find("follow=true") != std::string::npos);
                  who.open();
                  who.chunk(log_line("more"));
                });
    const auto x = b.get<log_excerpt>(query);
    CHECK(x.text == "more\n");
    CHECK_FALSE(x.ended);
  }
  SECTION("but not for ever") {
    query.wait_ms = 50;
    b.script.on("GET /containers/roscell-i/json", 200, running);
    b.script.on(
        "GET /containers/c1/logs",
        [](engine_caller& who, const engine_call_seen&) { who.open(); });
    const auto x = b.get<log_excerpt>(query);
    CHECK(x.text.empty());
    CHECK_FALSE(x.ended);
  }
  SECTION("there is none") {
    CHECK(b.refusal<log_excerpt>(query).code == error_code::unknown_task);
  }
}

TEST_CASE(
    "one follower of logs too many is told so, and not answered at once") {
  event_inbox opened;
  engine_bench b;
  b.script.on("GET /containers/roscell-i/json", 200, running);
  b.script.on("GET /containers/c1/logs",
              [&](engine_caller& who, const engine_call_seen&) {
                who.open();
                opened.put("opened");
              });
  log_query query;
  query.instance = "i";
  query.offset = 0;
  query.wait_ms = limits::log::wait.count();
  for (size_t i = 0; i < limits::log::followers; ++i) {
    caf::anon_send(b.runtime, query);
    opened.await("opened");
  }
  CHECK(b.refusal<log_excerpt>(query).code == error_code::conflict);
}

TEST_CASE("ids that cannot be names reach no engine") {
  engine_bench b;
  for (const auto* id : {"..", "", "../x", "a/b", "a?b"}) {
    CHECK_FALSE(b.ask<container_adopted>(adopt_container{id, {}}));
    CHECK_FALSE(b.ask<container_removed>(remove_container{id, {}}));
    CHECK_FALSE(b.ask<container_stopped>(stop_container{id, {}, 0}));
  }
}

TEST_CASE("an engine that talks nonsense does not break the runtime") {
  engine_bench b;
  b.script.on("POST /containers/create", 201, "[[]]");
  CHECK_FALSE(b.ask<container_started>(b.container()));
  b.script.on("GET /containers/roscell-i/json", 200,
              R"({"Id":7,"State":{"Running":"yes","ExitCode":"x"}})");
  CHECK_FALSE(b.get<container_adopted>(adopt_container{"i", {}}).running);
  b.script.on("GET /images/", 200, "\xff");
  b.ask<image_prepared>(b.image());
  CHECK(b.ask<actor_state>(state_query{}));
}
