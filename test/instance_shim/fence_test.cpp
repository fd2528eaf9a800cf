#include "test/instance_shim/shim_run.hpp"

#include <catch2/catch.hpp>

#include <csignal>
#include <ctime>

using namespace roscell::test;
using Catch::Matchers::Contains;

namespace {

/// Long enough for a busy machine to start a program.
constexpr std::int64_t soon_ms = 2'000;

constexpr std::int64_t hour_ms = 3'600'000;

std::int64_t boot_now_ms() {
  timespec now{};
  ::clock_gettime(CLOCK_BOOTTIME, &now);
  return now.tv_sec * 1000 + now.tv_nsec / 1'000'000;
}

/// The file with a fence, written as a node writes it.
struct fence_file {
  explicit fence_file(std::int64_t boot_ms) {
    move_to(boot_ms);
  }

  void move_to(std::int64_t boot_ms) const {
    const roscell::engine::unique_fd file{
        ::open(path.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0600)};
    REQUIRE(::pwrite(file.get(), &boot_ms, sizeof(boot_ms), 0)
            == static_cast<ssize_t>(sizeof(boot_ms)));
  }

  /// Empty, as a host makes it for a container.
  std::string exit_file() const {
    const auto result = folder / "exit";
    std::ofstream{result};
    return result;
  }

  temp_folder folder;
  std::string path = folder / "fence";
};

struct fenced_run : shim_run {
  fenced_run(const std::string& script, const fence_file& fence)
      : shim_run(script, 65536, {}, {"--fence", fence.path}) {
    // nop
  }

  bool is_up() {
    return wait_for("pid") && wait_for_log("up");
  }
};

/// As the first process of a container.
child_process run_plain(const std::string& script, const fence_file& fence,
                        const std::vector<std::string>& before = {}) {
  auto words = before;
  words.insert(words.end(),
               {shim, "--exit", fence.exit_file(), "--fence", fence.path,
                "--stop-signal", "2", "--", "/bin/sh", "-c", script});
  return child_process{words, {{"PATH", "/usr/sbin:/usr/bin:/sbin:/bin"}}};
}

/// How often a process has gone to sleep.
long sleeps_of(pid_t process) {
  constexpr const char* name = "voluntary_ctxt_switches:";
  const auto text = content_of("/proc/" + std::to_string(process) + "/status");
  return std::stol(text.substr(text.find(name) + std::strlen(name)));
}

/// Whoever writes a number in a line of its own must have ended.
void check_all_ended(const std::string& numbers, int expected) {
  std::istringstream text{numbers};
  auto count = 0;
  for (pid_t process = 0; text >> process; ++count)
    CHECK(::kill(process, 0) != 0);
  CHECK(count == expected);
}

} // namespace

TEST_CASE("a command ends with all that it has started when its fence passes") {
  const fence_file fence{boot_now_ms() + soon_ms};
  // One in its group, one in a session of its own whose child has another one.
  fenced_run run{"trap '' TERM; sleep 1000 & echo $!;"
                 " setsid sh -c 'echo $$; setsid sleep 1000 & echo $!; wait' &"
                 " while :; do wait; done",
                 fence};
  CHECK(run.process.wait() == 0);
  CHECK(run.exit()["signal"] == SIGKILL);
  CHECK(run.exit()["fenced"] == true);
  check_all_ended(run.log(0), 3);
}

TEST_CASE("a command goes on while its fence is moved on") {
  const auto first = boot_now_ms() + soon_ms;
  const fence_file fence{first};
  fenced_run run{"echo up; exec sleep 1000", fence};
  REQUIRE(run.is_up());
  fence.move_to(first + 1'000);
  CHECK(run.process.wait() == 0);
  CHECK(run.exit()["fenced"] == true);
  CHECK(boot_now_ms() >= first + 1'000);
}

TEST_CASE("a fence that cannot be read has not been moved on") {
  const fence_file fence{boot_now_ms() + soon_ms};
  fenced_run run{"echo up; exec sleep 1000", fence};
  REQUIRE(run.is_up());
  SECTION("it is not there") {
    std::filesystem::remove(fence.path);
  }
  SECTION("it is cut") {
    // Read as if zeros followed, it would not have passed.
    fence.move_to(boot_now_ms() + hour_ms);
    REQUIRE(::truncate(fence.path.c_str(), 7) == 0);
  }
  SECTION("it is empty") {
    REQUIRE(::truncate(fence.path.c_str(), 0) == 0);
  }
  SECTION("it is a folder") {
    std::filesystem::remove(fence.path);
    std::filesystem::create_directory(fence.path);
  }
  CHECK(run.process.wait() == 0);
  CHECK(run.exit()["fenced"] == true);
}

TEST_CASE("nothing is started behind a fence that has passed or is not there") {
  const fence_file fence{boot_now_ms() - 1};
  SECTION("it has passed") {
    CHECK(fence.path.size() > 0);
  }
  SECTION("it is long ago") {
    fence.move_to(0);
  }
  SECTION("it is not there") {
    std::filesystem::remove(fence.path);
  }
  fenced_run run{"exit 0", fence};
  CHECK(run.process.wait() == 1);
  CHECK_THAT(run.process.output(), Contains(fence.path));
  CHECK_FALSE(std::filesystem::exists(run.dir()));
}

TEST_CASE("moving a fence on does not wake the shim") {
  const auto moment = boot_now_ms() + hour_ms;
  const fence_file fence{moment};
  fenced_run run{"echo up; exec sleep 1000", fence};
  REQUIRE(run.is_up());
  const auto before = sleeps_of(run.process.pid());
  for (auto i = 1; i <= 1'000; ++i)
    fence.move_to(moment + i);
  // It may not have been asleep yet after it had written the log.
  CHECK(sleeps_of(run.process.pid()) <= before + 2);
  run.process.signal(SIGQUIT);
  CHECK(run.process.wait() == 0);
  CHECK(run.exit().count("fenced") == 0);
}

TEST_CASE("a fence is kept by the clock that goes on while the host sleeps") {
  constexpr std::int64_t slept_ms = 1'000'000;
  const fence_file fence{boot_now_ms() + slept_ms + soon_ms};
  // To this process the host has slept before, and no other clock knows.
  auto process =
      run_plain("echo up; exec sleep 1000", fence,
                {"/usr/bin/unshare", "--time", "--boottime", "1000", "--fork"});
  const auto code = process.wait();
  if (process.output().find("unshare") != std::string::npos)
    WARN("no namespaces of clocks here: " + process.output());
  else
    CHECK(code == 137);
}

TEST_CASE("without a folder the shim gives output and exit code unchanged") {
  const fence_file fence{boot_now_ms() + hour_ms};
  SECTION("of a command that exits") {
    auto process = run_plain("echo out; echo err >&2; exit 3", fence);
    CHECK(process.wait() == 3);
    CHECK(process.output() == "out\nerr\n");
  }
  SECTION("of a command that is killed") {
    CHECK(run_plain("kill -9 $$", fence).wait() == 137);
  }
  SECTION("of a command that cannot be run") {
    child_process process{
        {shim, "--exit", fence.exit_file(), "--", "/does/not/exist"}, {}};
    CHECK(process.wait() == 127);
    CHECK_THAT(process.output(), Contains("/does/not/exist"));
  }
}

TEST_CASE("without a folder the shim asks to end as it was told") {
  const fence_file fence{boot_now_ms() + hour_ms};
  const temp_folder folder;
  auto process =
      // The background process says so itself: before, it is a copy of the
      // shell that is not yet deaf to SIGINT.
      run_plain("trap 'echo asked; exit 7' INT; (: > " + (folder / "up")
                    + "; exec sleep 1000) & wait",
                fence);
  REQUIRE(wait_in_folder(
      folder / "", [&] { return std::filesystem::exists(folder / "up"); }));
  process.signal(SIGTERM);
  CHECK(process.wait() == 7);
  CHECK(process.output() == "asked\n");
}

TEST_CASE("without a folder the command ends when its fence passes") {
  const fence_file fence{boot_now_ms() + soon_ms};
  auto process =
      run_plain("setsid sleep 1000 & echo $!; exec sleep 1000", fence);
  CHECK(process.wait() == 137);
  check_all_ended(process.output(), 1);
}
