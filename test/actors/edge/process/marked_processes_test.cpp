#include "actors/edge/process/process_identity.hpp"

#include "actors/edge/process/process_spawner.hpp"
#include "test/actors/edge/process/supervision_fixture.hpp"

#include <csignal>
#include <string>

using namespace roscell;
using namespace roscell::test;
using namespace std::chrono_literals;

namespace {

spawned_program sleeper(const std::string& value) {
  return value_of(spawn_program(
      {"/bin/sh", {"-c", "exec >&- 2>&-; exec sleep 60"}, {{"MARK", value}}},
      30s));
}

} // namespace

TEST_CASE("a process is found that becomes another program meanwhile") {
  const temp_folder folder;
  const auto value = folder.path().string();
  // Most of its life it is on the way from one program to the next.
  const std::string script = "exec >&- 2>&-; [ $1 = 200 ] && exec sleep 60; "
                             "exec /bin/sh -c \"$0\" \"$0\" $(($1 + 1))";
  for (int trial = 0; trial < 20; ++trial) {
    const auto restless = value_of(spawn_program(
        {"/bin/sh", {"-c", script, script, "0"}, {{"MARK", value}}}, 30s));
    CHECK(kill_marked_processes("MARK", value) == 1);
    CHECK(reap(restless.pidfd.get()) == 128 + SIGKILL);
  }
}

TEST_CASE("only processes with the very variable are killed") {
  // Unlike that of any other run of this test.
  const temp_folder folder;
  const auto value = folder.path().string();
  const auto marked = sleeper(value);
  const auto other = sleeper(value + "2");
  CHECK(kill_marked_processes("MARK", value) == 1);
  CHECK(has_ended(marked.pidfd.get()));
  CHECK_FALSE(has_ended(other.pidfd.get()));
  CHECK(reap(marked.pidfd.get()) == 128 + SIGKILL);
  CHECK(kill_marked_processes("MARK", value) == 0);
  CHECK(kill_marked_processes("MARK", value + "2") == 1);
  reap(other.pidfd.get());
}
