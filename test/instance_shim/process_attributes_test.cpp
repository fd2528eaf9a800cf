#include "test/instance_shim/shim_run.hpp"

#include <catch2/catch.hpp>

#include <sys/resource.h>
#include <unistd.h>

using namespace roscell::test;
using Catch::Matchers::Contains;
using Catch::Matchers::StartsWith;

namespace {

/// What a program has from who has started it, a line each.
constexpr const char* print_attributes =
    "umask; nice; ulimit -c; ulimit -r; cut -d ' ' -f 41 /proc/$$/stat; "
    "cat /proc/$$/oom_score_adj; cut -d ' ' -f 19 /proc/$PPID/stat; "
    "grep Cpus_allowed_list /proc/$$/status; grep CapAmb /proc/$$/status";

/// Runs a script under a shim that somebody has started who is nobody's equal.
struct special_run {
  explicit special_run(const std::string& script,
                       const std::vector<std::string>& options = {})
      : process(command(script, options),
                {{"PATH", "/usr/sbin:/usr/bin:/bin"}}) {
    // nop
  }

  std::vector<std::string> command(const std::string& script,
                                   const std::vector<std::string>& options) {
    std::vector<std::string> result{
        "/bin/bash",
        "-c",
        "umask 077; ulimit -c unlimited; echo 300 > /proc/self/oom_score_adj; "
        "exec chrt -f 10 nice -n -5 taskset 1 \"$@\"",
        "-",
        shim,
        "--dir",
        folder / "i",
        "--log-bytes",
        "65536"};
    result.insert(result.end(), options.begin(), options.end());
    result.insert(result.end(), {"--", "/bin/bash", "-c", script});
    return result;
  }

  std::string log() const {
    return content_of(folder / "i/log.0");
  }

  temp_folder folder;
  child_process process;
};

bool may_be_special() {
  if (::geteuid() != 0)
    WARN("SKIPPED: needs root");
  return ::geteuid() == 0;
}

} // namespace

TEST_CASE("a command is an ordinary one, whatever its node is", "[status]") {
  if (!may_be_special())
    return;
  special_run run{print_attributes};
  REQUIRE(run.process.wait() == 0);
  std::istringstream lines{run.log()};
  std::vector<std::string> all;
  for (std::string line; std::getline(lines, line);)
    all.push_back(line);
  REQUIRE(all.size() == 9);
  CHECK(all[0] == "0022");
  CHECK(all[1] == "0");
  CHECK(all[2] == "0");
  CHECK(all[3] == "0");
  // SCHED_OTHER.
  CHECK(all[4] == "0");
  // Before the shim, which has the node's or less.
  CHECK((all[5] == "400" || all[5] == "0"));
  // The shim goes on as the node, so that no skill starves the fence.
  CHECK(all[6] == std::to_string(::getpriority(PRIO_PROCESS, 0) - 5));
  // Which processors are ours is said by whoever has set the node up.
  CHECK(all[7] == "Cpus_allowed_list:\t0");
  CHECK_THAT(all[8], Contains("0000000000000000"));
}

TEST_CASE("a command is scheduled as it is granted", "[status]") {
  if (!may_be_special())
    return;
  special_run fifo{"chrt -p $$", {"--scheduling", "fifo:20:0"}};
  REQUIRE(fifo.process.wait() == 0);
  if (fifo.log().find("Operation not permitted") != std::string::npos)
    WARN("SKIPPED: this cgroup has no real-time share");
  else
    CHECK_THAT(fifo.log(), Contains("SCHED_FIFO") && Contains("priority: 20"));
  special_run nice{"nice", {"--scheduling", "other:0:-7"}};
  REQUIRE(nice.process.wait() == 0);
  CHECK(nice.log() == "-7\n");
  special_run idle{"chrt -p $$", {"--scheduling", "idle:0:0"}};
  REQUIRE(idle.process.wait() == 0);
  CHECK_THAT(idle.log(), Contains("SCHED_IDLE"));
}

TEST_CASE("a scheduling that the kernel refuses is told", "[status]") {
  if (!may_be_special())
    return;
  temp_folder folder;
  // Nobody may raise himself.
  child_process process{{"/usr/bin/setpriv", "--reuid", "65534",
                         "--clear-groups", "--inh-caps=-all",
                         "--bounding-set=-all", shim, "--exit", "/dev/null",
                         "--scheduling", "fifo:20:0", "--", "/bin/true"},
                        {}};
  CHECK(process.wait() == 127);
  CHECK_THAT(process.output(), Contains("cannot schedule as it was granted"));
}

TEST_CASE("words that are no scheduling are refused", "[status]") {
  for (const auto* words :
       {"fifo", "fifo:1", "fifo:100:0", "rr:-1:0", "best:1:0", "other:0:20",
        "other:0:-21", "other::", "fifo:1:0:0", ""}) {
    child_process process{
        {shim, "--exit", "/dev/null", "--scheduling", words, "--", "/bin/true"},
        {}};
    CAPTURE(words);
    CHECK(process.wait() == 2);
  }
}
