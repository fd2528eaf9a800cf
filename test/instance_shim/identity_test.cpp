#include "actors/edge/process/process_identity.hpp"
#include "test/instance_shim/shim_run.hpp"

#include <catch2/catch.hpp>

#include <poll.h>
#include <unistd.h>

#include <csignal>

using namespace roscell::test;

namespace {

constexpr const char* who_am_i =
    "grep -E '^(Uid|Gid|Groups|Cap(Inh|Prm|Eff|Bnd|Amb)|NoNewPrivs):'"
    " /proc/self/status";

/// A line of the above, its blanks as one.
std::string line_of(const shim_run& run, const std::string& name) {
  std::istringstream lines{run.log(0)};
  for (std::string line; std::getline(lines, line);)
    if (line.rfind(name + ":", 0) == 0) {
      std::istringstream words{line.substr(name.size() + 1)};
      std::string result;
      for (std::string word; words >> word;)
        result += (result.empty() ? "" : " ") + word;
      return result;
    }
  return "none";
}

constexpr const char* no_capability = "0000000000000000";

} // namespace

TEST_CASE("a command has no capability, and gains none", "[identity]") {
  shim_run run{who_am_i, 65536, {}, {"--capabilities", "0"}};
  CHECK(run.process.wait() == 0);
  for (const auto* set : {"CapInh", "CapPrm", "CapEff", "CapAmb"})
    CHECK(line_of(run, set) == no_capability);
  CHECK(line_of(run, "NoNewPrivs") == "1");
  if (::geteuid() == 0)
    CHECK(line_of(run, "CapBnd") == no_capability);
}

TEST_CASE("a command of root has those that it is granted", "[identity]") {
  if (::geteuid() != 0)
    return;
  // NET_RAW is number 13.
  shim_run run{who_am_i, 65536, {}, {"--capabilities", "2000"}};
  CHECK(run.process.wait() == 0);
  for (const auto* set : {"CapPrm", "CapEff", "CapBnd"})
    CHECK(line_of(run, set) == "0000000000002000");
}

TEST_CASE("a command of another user has his groups and what it is granted",
          "[identity]") {
  if (::geteuid() != 0)
    return;
  shim_run run{who_am_i,
               65536,
               {},
               {"--user", "65534:65533,27,44", "--capabilities", "2000"}};
  CHECK(run.process.wait() == 0);
  CHECK(line_of(run, "Uid") == "65534 65534 65534 65534");
  CHECK(line_of(run, "Gid") == "65533 65533 65533 65533");
  CHECK(line_of(run, "Groups") == "27 44");
  for (const auto* set : {"CapPrm", "CapEff", "CapBnd", "CapAmb"})
    CHECK(line_of(run, set) == "0000000000002000");
  CHECK(line_of(run, "NoNewPrivs") == "1");
}

TEST_CASE("a command of another user ends with its shim", "[identity]") {
  if (::geteuid() != 0)
    return;
  shim_run run{
      "echo up; exec sleep 1000", 65536, {}, {"--user", "65534:65534"}};
  REQUIRE((run.wait_for("pid") && run.wait_for_log("up")));
  const roscell::engine::unique_fd child{
      ::pidfd_open(static_cast<pid_t>(run.pids()[2]), 0)};
  REQUIRE(child.get() >= 0);
  ::kill(static_cast<pid_t>(run.pids()[0]), SIGKILL);
  run.process.wait();
  // The kernel sends the signal when the parent ends; the end takes a moment.
  pollfd ended{child.get(), POLLIN, 0};
  CHECK(::poll(&ended, 1, 5000) == 1);
}

TEST_CASE("words that are no identity are refused", "[identity]") {
  const auto words =
      GENERATE(std::vector<std::string>{"--user", "65534"},
               std::vector<std::string>{"--user", "nobody:nogroup"},
               std::vector<std::string>{"--user", "1:2:3"},
               std::vector<std::string>{"--user", "4294967295:1"},
               std::vector<std::string>{"--user", "-1:1"},
               std::vector<std::string>{"--capabilities", "x"},
               std::vector<std::string>{"--capabilities", ""});
  shim_run run{"true", 65536, {}, words};
  CHECK(run.process.wait() == 2);
}
