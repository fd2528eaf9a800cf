#include "actors/instances/process/process_runtime.hpp"

#include "actors/edge/disk/folder_hash.hpp"
#include "actors/edge/history/kept_log_folder.hpp"
#include "actors/edge/process/notify_socket.hpp"
#include "actors/edge/process/process_identity.hpp"
#include "test/actors/instances/process/process_bench.hpp"
#include "test/places.hpp"

#include <poll.h>
#include <unistd.h>

#include <csignal>
#include <string>

using namespace roscell;
using namespace roscell::test;
namespace fs = std::filesystem;

TEST_CASE("a program's exit is told at once, with its code") {
  process_bench b;
  b.start("exit 3");
  CHECK(b.reported.take() == "exit 3");
}

TEST_CASE("a program gets its arguments, environment and working folder") {
  process_bench b;
  b.start("echo \"$1 $GIVEN $(pwd) $LANG\"");
  CHECK(b.reported.take() == "exit 0");
  CHECK(b.log(0).text
        == "an argument yes " + (b.folder.path() / "skill").string() + " "
               + b.config.environment.at("LANG") + "\n");
}

TEST_CASE("a program that cannot be run ends with 127 and says why") {
  process_bench b;
  b.folder.write("skill/bin/run", "", true);
  b.instances.push_back("i");
  start_container order;
  order.instance = "i";
  order.image = b.folder.path() / "skill";
  order.command = {"bin/none"};
  b.get<container_started>(order);
  CHECK(b.reported.take() == "exit 127");
  CHECK(b.log(0).text.find("No such file") != std::string::npos);
}

TEST_CASE("a shim that is not there is a clear error") {
  process_bench b;
  b.config.shim = "/no/such/shim";
  b.restart();
  start_container order;
  order.instance = "i";
  order.image = b.folder.path();
  order.command = {"run"};
  const auto answer = b.ask<container_started>(order);
  REQUIRE_FALSE(answer);
  const auto why = to_failure(answer.error());
  CHECK(why.code == error_code::engine_failed);
  CHECK(why.message.find("/no/such/shim") != std::string::npos);
}

TEST_CASE("an entry point is checked before anything is started") {
  process_bench b;
  b.folder.write("skill/bin/plain", "");
  b.folder.write("skill/bin/run", "", true);
  const auto folder = b.folder.path() / "skill";
  const auto hash = std::get<std::string>(hash_folder(folder));
  const auto prepare = [&](const std::string& program) {
    return b.ask<image_prepared>(prepare_image{
        "i", "echo", folder.string(), hash, {}, {program}, "image"});
  };
  CHECK(prepare("bin/run"));
  for (const auto* program : {"bin/none", "bin", "bin/plain"}) {
    const auto answer = prepare(program);
    REQUIRE_FALSE(answer);
    const auto why = to_failure(answer.error());
    CHECK(why.code == error_code::engine_failed);
    CHECK(why.message.find(program) != std::string::npos);
    CHECK_FALSE(why.hint.empty());
  }
  // What is there now is not what was hashed.
  b.folder.write("skill/model", "");
  CHECK_FALSE(prepare("bin/run"));
}

TEST_CASE("a killed program is told of by its signal") {
  process_bench b;
  b.start(endless);
  ::kill(child_of(b), SIGKILL);
  CHECK(b.reported.take() == "exit 137");
}

TEST_CASE("a killed shim takes its program along and is told of") {
  process_bench b;
  const auto container = b.start(endless);
  const auto child = child_of(b);
  ::kill(pid_of(container), SIGKILL);
  // The signal was not the program's.
  CHECK(b.reported.take() == "exit -1, supervision");
  CHECK(b.log(0).ended);
  // The program dies by the kernel's hand, a moment later at most.
  const unique_fd pidfd{::pidfd_open(child, 0)};
  if (pidfd) {
    pollfd waited{pidfd.get(), POLLIN, 0};
    CHECK(::poll(&waited, 1, 30'000) == 1);
  }
}

TEST_CASE("what a killed shim's program has started elsewhere ends, too") {
  process_bench b;
  // It has a session and a parent of its own, and tells its number.
  const auto container =
      b.start("setsid sh -c 'echo $$; " + endless + "' & " + endless);
  const auto text = b.log(0, 20'000).text;
  const unique_fd pidfd{::pidfd_open(std::stoi(text), 0)};
  REQUIRE(pidfd);
  SECTION("while the node is there") {
    ::kill(pid_of(container), SIGKILL);
    CHECK(b.reported.take() == "exit -1, supervision");
  }
  SECTION("while it is away") {
    b.leave();
    // The kernel may take a moment.
    const unique_fd shim{::pidfd_open(pid_of(container), 0)};
    ::kill(pid_of(container), SIGKILL);
    pollfd ended{shim.get(), POLLIN, 0};
    CHECK(::poll(&ended, 1, 30'000) == 1);
    b.restart();
    CHECK_FALSE(
        b.get<container_adopted>(adopt_container{"i", container}).running);
  }
  pollfd waited{pidfd.get(), POLLIN, 0};
  CHECK(::poll(&waited, 1, 5'000) == 1);
}

TEST_CASE("words that wait at a socket are told before the answer to hearing") {
  process_bench b;
  b.start(endless);
  caf::anon_send(b.runtime, hear_container{"i"});
  CHECK(b.reported.take() == "heard");
  caf::anon_send(b.runtime, hear_container{"nobody"});
  CHECK(b.reported.take() == "heard");
}

TEST_CASE("stopping asks first, and force follows after the grace") {
  process_bench b;
  SECTION("a program that obeys") {
    b.start("trap 'exit 5' TERM; echo up; " + endless);
    CHECK(b.log(0, 20'000).text == "up\n");
    CHECK(b.get<container_stopped>(stop_container{"i", {}, 20'000}).exit_code
          == 5);
  }
  SECTION("a program that does not") {
    b.start("trap '' TERM; echo deaf; " + endless);
    CHECK(b.log(0, 20'000).text == "deaf\n");
    CHECK(b.get<container_stopped>(stop_container{"i", {}, 50}).exit_code
          == 137);
  }
  // It may be asked again, and has ended once.
  b.get<container_stopped>(stop_container{"i", {}, 50});
}

TEST_CASE("whoever has asked politely may go over to force") {
  process_bench b;
  b.start("trap '' TERM; echo deaf; " + endless);
  CHECK(b.log(0, 20'000).text == "deaf\n");
  // Longer than a test has patience.
  caf::anon_send(b.runtime, stop_container{"i", {}, 60'000});
  CHECK(b.get<container_stopped>(stop_container{"i", {}, 0}).exit_code == 137);
}

TEST_CASE("a program has a file by which it can be told of another address") {
  process_bench b;
  b.start("echo $NOTIFY_SOCKET; " + endless);
  const auto socket = b.log(0, 20'000).text;
  const auto file = environment_file_of(socket.substr(0, socket.size() - 1));
  CHECK(fs::is_fifo(file));
  b.get<container_removed>(remove_container{"i", {}});
  CHECK_FALSE(fs::exists(file));
}

TEST_CASE("removing ends by force and leaves no file") {
  process_bench b;
  b.start("trap '' TERM; echo deaf; " + endless);
  b.log(0, 20'000);
  b.get<container_removed>(remove_container{"i", {}});
  CHECK(fs::is_empty(b.config.instances_dir));
  b.get<container_removed>(remove_container{"i", {}});
  log_query query;
  query.instance = "i";
  const auto answer = b.ask<log_excerpt>(query);
  REQUIRE_FALSE(answer);
  CHECK(to_failure(answer.error()).code == error_code::unknown_task);
}

TEST_CASE("a log that is kept goes to the history") {
  process_bench b;
  event_inbox kept;
  const auto history = b.system.spawn([&kept]() -> caf::behavior {
    return {[&kept](const log_kept&) { kept.put("kept"); }};
  });
  b.config.kept_logs = b.folder.path() / "history";
  b.config.history = caf::actor_cast<node_history_actor>(history);
  b.restart();
  b.start("echo one; exit 3");
  b.reported.await("exit 3");
  kept_log about;
  about.instance = "i";
  about.ended_unix_ms = 1000;
  b.get<container_removed>(remove_container{"i", {}, false, {about}});
  CHECK(kept.take() == "kept");
  CHECK(fs::is_empty(b.config.instances_dir));
  const kept_log_folder folder{b.config.kept_logs};
  REQUIRE(folder.newest_of("i"));
  CHECK(folder.newest_of("i")->read_from(0).text == "one\n");
  // What is not there any more is no reason to fail.
  b.get<container_removed>(remove_container{"i", {}, false, {about}});
  CHECK(folder.list({}).logs.size() == 1);
  end_and_await(b.self, history);
}

TEST_CASE("an instance that runs is not started twice") {
  process_bench b;
  b.start(endless);
  start_container order;
  order.instance = "i";
  order.image = b.folder.path() / "skill";
  order.command = {"bin/run"};
  CHECK_FALSE(b.ask<container_started>(order));
  // Not even by a runtime that does not know of it.
  b.restart();
  CHECK_FALSE(b.ask<container_started>(order));
}

TEST_CASE("the log of an instance that is started again goes on") {
  process_bench b;
  b.start("echo one");
  b.reported.await("exit 0");
  b.get<container_removed>(remove_container{"i", {}, true});
  b.start("echo two");
  b.reported.await("exit 0");
  CHECK(b.log(0).text == "one\n[shim: started again]\ntwo\n");
}

TEST_CASE("the last program of an instance is adopted, whatever is on record") {
  process_bench b;
  const auto before = b.start("echo one");
  b.reported.await("exit 0");
  const auto present = b.start(endless);
  b.restart();
  const auto adopted = b.get<container_adopted>(adopt_container{"i", before});
  CHECK(adopted.running);
  CHECK(adopted.container == present);
}

TEST_CASE("a restarted runtime adopts what runs and sees its end") {
  process_bench b;
  const auto container = b.start("sleep 60; exit 4");
  b.restart();
  std::string known;
  SECTION("by the container's id") {
    known = container;
  }
  SECTION("by the records in its folder") {}
  const auto adopted = b.get<container_adopted>(adopt_container{"i", known});
  CHECK(adopted.running);
  CHECK(adopted.container == container);
  CHECK(b.get<container_adopted>(adopt_container{"i", known}).running);
  ::kill(child_of(b), SIGKILL);
  CHECK(b.reported.take() == "exit 137");
  CHECK_FALSE(b.get<container_adopted>(adopt_container{"i", known}).running);
}

TEST_CASE("a restarted runtime learns how an instance has ended meanwhile") {
  process_bench b;
  const auto container = b.start("exit 6");
  b.reported.await("exit 6");
  b.restart();
  const auto adopted =
      b.get<container_adopted>(adopt_container{"i", container});
  CHECK_FALSE(adopted.running);
  CHECK(adopted.exit_code == 6);
}

TEST_CASE("another process with the same number is not adopted") {
  process_bench b;
  const auto self_pid = std::to_string(::getpid());
  const auto start = to_container(*identify(::getpid()));
  for (const auto& container : {start, self_pid + ":1"})
    CHECK_FALSE(
        b.get<container_adopted>(adopt_container{"i", container}).running);
  CHECK_FALSE(b.get<container_adopted>(adopt_container{"none", {}}).running);
}

TEST_CASE("an order for an older container does not touch the present one") {
  process_bench b;
  b.start(endless);
  b.get<container_stopped>(stop_container{"i", "1:1", 0});
  b.get<container_removed>(remove_container{"i", "1:1"});
  CHECK(b.get<container_adopted>(adopt_container{"i", {}}).running);
}

TEST_CASE("ids that are no file names reach no file") {
  process_bench b;
  for (const auto* id : {"..", "", "../x", "a/b", ".hidden"}) {
    CHECK_FALSE(b.ask<container_adopted>(adopt_container{id, {}}));
    CHECK_FALSE(b.ask<container_removed>(remove_container{id, {}}));
    CHECK_FALSE(b.ask<container_stopped>(stop_container{id, {}, 0}));
    log_query query;
    query.instance = id;
    CHECK_FALSE(b.ask<log_excerpt>(query));
  }
}

TEST_CASE("the echo skill says that it is ready, and again after a restart") {
  process_bench b;
  const auto skill = fs::path{test::build_dir()} / "skills/echo";
  if (!fs::exists(skill / "bin/echo")) {
    WARN("skipped: the echo skill is not built");
    return;
  }
  const auto input = b.folder.path() / "in";
  fs::create_directory(input);
  fs::create_directory(b.folder.path() / "out");
  b.instances.push_back("i");
  start_container order;
  order.instance = "i";
  order.image = skill;
  order.command = {"bin/echo"};
  const auto stream = [](const fs::path& path) {
    return R"([{"protocol":"file","endpoint":")" + path.string()
           + R"(","data_type":"text/plain"}])";
  };
  order.environment = {{"ROSCELL_MODEL", "plain"},
                       {"ROSCELL_INPUTS", stream(input)},
                       {"ROSCELL_OUTPUTS", stream(b.folder.path() / "out")},
                       {"WATCHDOG_USEC", "200000"}};
  b.get<container_started>(order);
  CHECK(b.reported.take() == "ready");
  b.restart();
  CHECK(b.get<container_adopted>(adopt_container{"i", {}}).running);
  b.reported.await("ready");
  b.get<container_stopped>(stop_container{"i", {}, 20'000});
}
