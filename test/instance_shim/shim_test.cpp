#include "test/instance_shim/shim_run.hpp"

#include <catch2/catch.hpp>

#include <csignal>

using namespace roscell::test;
using Catch::Matchers::Contains;
using Catch::Matchers::StartsWith;

namespace {

/// `seq -w 0 9999` and the like: `count` lines of five bytes.
std::string numbered_lines(int count) {
  std::string result;
  for (auto i = 0; i < count; ++i)
    result += std::to_string(10'000 + i).substr(1) + "\n";
  return result;
}

} // namespace

TEST_CASE("the shim records an exit code, the output and the processes") {
  shim_run run{"echo out; echo err >&2; read x || echo no input; exit 3"};
  CHECK(run.process.wait() == 0);
  CHECK(run.exit()["code"] == 3);
  CHECK(run.exit()["signal"].is_null());
  CHECK(run.exit()["at_unix_ms"].is_number_unsigned());
  CHECK(run.log(0) == "out\nerr\nno input\n");
  CHECK(run.pids()[0] == static_cast<unsigned long>(run.process.pid()));
  CHECK(run.pids()[1] > 0);
  CHECK(names_in(run.dir())
        == std::vector<std::string>{"exit", "log.0", "pid", "times.0"});
}

TEST_CASE("the shim records the signal that ended its child") {
  shim_run run{"kill -9 $$"};
  CHECK(run.process.wait() == 0);
  CHECK(run.exit()["code"].is_null());
  CHECK(run.exit()["signal"] == 9);
}

TEST_CASE("the shim records that it was told to end its child") {
  const bool told = GENERATE(false, true);
  shim_run run{"trap 'exit 0' TERM; echo up; while :; do sleep 0.01; done"};
  REQUIRE((run.wait_for("pid") && run.wait_for_log("up")));
  // A signal to the child alone is an end as any other.
  ::kill(static_cast<pid_t>(run.pids()[told ? 0 : 2]), SIGTERM);
  CHECK(run.process.wait() == 0);
  CHECK(run.exit()["code"] == 0);
  CHECK(run.exit().value("terminated", false) == told);
}

TEST_CASE("in a container the shim records the end in a file of the host") {
  temp_folder folder;
  const auto file = folder / "exit";
  std::ofstream{file} << std::string(256, '\0');
  child_process process{
      {shim, "--exit", file, "--", "/bin/sh", "-c", "echo out; exit 3"}, {}};
  CHECK(process.wait() == 3);
  CHECK(json::parse(content_of(file))["code"] == 3);
  CHECK(names_in(folder / "") == std::vector<std::string>{"exit"});
  // Nothing runs whose end nobody would know.
  child_process other{{shim, "--exit", folder / "none", "--", "/bin/true"}, {}};
  CHECK(other.wait() == 1);
}

TEST_CASE("the shim notes when what stands in a log was written") {
  shim_run run{"echo one; sleep 0.05; echo two"};
  CHECK(run.process.wait() == 0);
  CHECK(run.log(0) == "one\ntwo\n");
  const auto notes = run.times(0);
  REQUIRE(notes.size() == 2);
  CHECK(notes[0].first == 0);
  CHECK(notes[1].first == 4);
  CHECK(notes[1].second >= notes[0].second + 40);
  CHECK(notes[1].second <= run.exit()["at_unix_ms"].get<std::int64_t>());
}

TEST_CASE("the times of a log are bounded as the log is") {
  // A program that is started for each line takes a millisecond at least, so
  // the lines have times of their own: a quarter of a file's 2 KiB holds 32.
  shim_run run{"for i in $(seq 100); do /bin/echo $i; sleep 0.002; done", 4096};
  CHECK(run.process.wait() == 0);
  REQUIRE(run.log_offsets().size() == 2);
  CHECK(run.log_offsets().front() > 0);
  for (const auto offset : run.log_offsets()) {
    CHECK(run.times(offset).size() <= 32);
    CHECK(run.times(offset).front().first == static_cast<std::int64_t>(offset));
  }
}

TEST_CASE("the shim tells why a command could not be run") {
  temp_folder folder;
  child_process process{{shim, "--dir", folder / "i", "--log-bytes", "4096",
                         "--", "/does/not/exist", "x"},
                        {}};
  CHECK(process.wait() == 0);
  CHECK(json::parse(content_of(folder / "i/exit"))["code"] == 127);
  CHECK_THAT(content_of(folder / "i/log.0"),
             Contains("/does/not/exist") && Contains("No such file"));
}

TEST_CASE("the shim names an interpreter that is not there") {
  const auto [line, words] = GENERATE(
      std::pair{"#!/no/such/python\n", "interpreter '/no/such/python' is not"},
      std::pair{"#! /no/such/env python\n",
                "interpreter '/no/such/env' is not"},
      std::pair{"#!/bin/sh\r\n", "'/bin/sh' has a CR behind it"});
  temp_folder folder;
  const auto script = folder / "script";
  std::ofstream{script} << line << "true\n";
  REQUIRE(::chmod(script.c_str(), 0755) == 0);
  child_process process{
      {shim, "--dir", folder / "i", "--log-bytes", "4096", "--", script}, {}};
  CHECK(process.wait() == 0);
  CHECK(json::parse(content_of(folder / "i/exit"))["code"] == 127);
  CHECK_THAT(content_of(folder / "i/log.0"), Contains(words));
}

TEST_CASE("a program that is still being written is run when it is closed") {
  temp_folder folder;
  const auto script = folder / "script";
  std::ofstream{script} << "#!/bin/sh\necho up\n";
  REQUIRE(::chmod(script.c_str(), 0755) == 0);
  child_process writer{{"/bin/sh", "-c",
                        "exec 9>>\"$0\"; : > \"$1\"; exec sleep 0.3", script,
                        folder / "open"},
                       {{"PATH", "/usr/bin:/bin"}}};
  REQUIRE(wait_in_folder(
      folder / "", [&] { return std::filesystem::exists(folder / "open"); }));
  child_process process{
      {shim, "--dir", folder / "i", "--log-bytes", "4096", "--", script}, {}};
  CHECK(process.wait() == 0);
  CHECK(content_of(folder / "i/log.0") == "up\n");
  CHECK(writer.wait() == 0);
}

TEST_CASE("the shim runs the command in the folder it is told") {
  temp_folder folder;
  folder.write("here", "found\n");
  child_process process{{shim, "--dir", folder / "i", "--log-bytes", "4096",
                         "--cwd", folder / "", "--", "/bin/cat", "here"},
                        {}};
  CHECK(process.wait() == 0);
  CHECK(content_of(folder / "i/log.0") == "found\n");
}

TEST_CASE("the start time on record is that of the shim's process") {
  shim_run run{"read x < /dev/null; exec sleep 1000"};
  REQUIRE(run.wait_for("pid"));
  auto stat = content_of("/proc/" + std::to_string(run.pids()[0]) + "/stat");
  std::istringstream fields{stat.substr(stat.rfind(')') + 2)};
  std::string field;
  for (auto i = 3; i <= 22; ++i)
    fields >> field;
  CHECK(field == std::to_string(run.pids()[1]));
  run.process.signal(SIGTERM);
  CHECK(run.process.wait() == 0);
  CHECK(run.exit()["signal"] == SIGTERM);
}

TEST_CASE("the log is bounded, and its files carry their absolute offsets") {
  shim_run run{"seq -w 0 9999", 4096};
  CHECK(run.process.wait() == 0);
  auto all = numbered_lines(10'000);
  auto offsets = run.log_offsets();
  REQUIRE(offsets.size() == 2);
  CHECK(offsets[0] % 2048 == 0);
  CHECK(offsets[1] == offsets[0] + 2048);
  CHECK(run.log(offsets[0]) == all.substr(offsets[0], 2048));
  CHECK(run.log(offsets[1]) == all.substr(offsets[1]));
}

TEST_CASE("a log that exists is continued at its absolute offset") {
  temp_folder folder;
  std::vector<std::string> command{shim,   "--dir", folder / "i", "--log-bytes",
                                   "4096", "--",    "/bin/echo",  "hello"};
  child_process first{command, {}};
  CHECK(first.wait() == 0);
  child_process second{command, {}};
  CHECK(second.wait() == 0);
  CHECK(names_in(folder / "i")
        == std::vector<std::string>{"exit", "log.0", "pid", "times.0"});
  CHECK(content_of(folder / "i/log.0")
        == "hello\n[shim: started again]\nhello\n");
  SECTION("in the next file where the newest is full") {
    std::ofstream{folder / "i/log.0", std::ios::app} << std::string(2048, 'x');
    const auto next = "log." + std::to_string(34 + 2048);
    child_process third{command, {}};
    CHECK(third.wait() == 0);
    CHECK(names_in(folder / "i")
          == std::vector<std::string>{"exit", "log.0", next, "pid", "times.0",
                                      "times." + next.substr(4)});
    CHECK(content_of(folder / ("i/" + next))
          == "\n[shim: started again]\nhello\n");
    // Of two files both go on; of three the oldest goes.
    folder.write("i/log.7", "not the oldest\n");
    child_process fourth{command, {}};
    CHECK(fourth.wait() == 0);
    CHECK_FALSE(std::filesystem::exists(folder / "i/log.0"));
    CHECK(std::filesystem::exists(folder / "i/log.7"));
  }
  SECTION("with the times behind those of before") {
    const auto size = std::filesystem::file_size(folder / "i/times.0");
    // Half a note, and one of bytes that were lost with the power.
    const std::int64_t lost[] = {1000, 1, 7};
    std::ofstream{folder / "i/times.0", std::ios::app | std::ios::binary}.write(
        reinterpret_cast<const char*>(lost), 20);
    child_process third{command, {}};
    CHECK(third.wait() == 0);
    const auto after = std::filesystem::file_size(folder / "i/times.0");
    CHECK(after % 16 == 0);
    CHECK(after > size);
  }
}

TEST_CASE("a log that cannot be written never holds the child back") {
  // No file can grow beyond 1000 bytes, as on a disk that is full.
  shim_run run{"seq -w 0 9999 && exit 5", 65536, 1000};
  CHECK(run.process.wait() == 0);
  CHECK(run.exit()["code"] == 5);
  CHECK(run.log(0) == numbered_lines(10'000).substr(0, 1000));
}

TEST_CASE("SIGTERM to the shim reaches the whole process group") {
  shim_run run{"sleep 1000 & trap 'echo asked; exit 7' TERM; echo up; wait"};
  REQUIRE(run.wait_for("pid"));
  REQUIRE(run.wait_for_log("up"));
  run.process.signal(SIGTERM);
  CHECK(run.process.wait() == 0);
  CHECK(run.exit()["code"] == 7);
  CHECK(run.log(0) == "up\nasked\n");
}

TEST_CASE("SIGQUIT to the shim kills what ignores SIGTERM") {
  shim_run run{"trap '' TERM; echo up; while :; do sleep 1000; done"};
  REQUIRE(run.wait_for("pid"));
  REQUIRE(run.wait_for_log("up"));
  run.process.signal(SIGTERM);
  run.process.signal(SIGQUIT);
  CHECK(run.process.wait() == 0);
  CHECK(run.exit()["signal"] == SIGKILL);
}

TEST_CASE("SIGUSR1 to the shim reaches the command alone") {
  shim_run run{"trap 'echo asked; exit 7' USR1;"
               " sh -c 'trap \"echo wrong\" USR1; echo up;"
               " while :; do sleep 1000 & wait $!; done' &"
               " while :; do wait; done"};
  REQUIRE(run.wait_for("pid"));
  REQUIRE(run.wait_for_log("up"));
  run.process.signal(SIGUSR1);
  CHECK(run.process.wait() == 0);
  CHECK(run.exit()["code"] == 7);
  CHECK(run.exit().count("fenced") == 0);
  CHECK(run.log(0) == "up\nasked\n");
}

TEST_CASE("nothing that the child started outlives it") {
  // One in the group of the child, one that has left it; both hold the pipe.
  shim_run run{"sleep 1000 & echo $!; setsid sleep 1000 & echo $!; exit 0"};
  CHECK(run.process.wait() == 0);
  CHECK(run.exit()["code"] == 0);
  std::istringstream log{run.log(0)};
  pid_t pid = 0;
  auto count = 0;
  while (log >> pid) {
    ++count;
    CHECK(::kill(pid, 0) != 0);
  }
  CHECK(count == 2);
}

TEST_CASE("the child dies with its shim") {
  shim_run run{"echo up; exec sleep 1000"};
  REQUIRE(run.wait_for("pid"));
  REQUIRE(run.wait_for_log("up"));
  auto child = static_cast<pid_t>(run.pids()[2]);
  run.process.signal(SIGKILL);
  CHECK(wait_for_end(child));
  CHECK_FALSE(std::ifstream{run.dir() + "/exit"}.good());
}

TEST_CASE("the shim and its child survive the process that started them") {
  temp_folder folder;
  auto dir = folder / "i";
  // `cat` ends, and then the parent kills itself, when the shim has closed the
  // output it was given. It does so once its records are there.
  child_process parent{
      {"/bin/sh", "-c",
       "{ " + shim + " --dir " + dir
           + " --log-bytes 4096 -- /bin/sleep 1000 & } | cat; kill -9 $$"},
      {{"PATH", "/usr/bin:/bin"}}};
  CHECK(parent.wait() == -SIGKILL);
  std::istringstream text{record_of_processes(dir)};
  pid_t pid = 0;
  REQUIRE(text >> pid);
  CHECK(::kill(pid, 0) == 0);
  CHECK(content_of(dir + "/exit").empty());
  ::kill(pid, SIGTERM);
  CHECK(wait_for_end(pid));
  CHECK(json::parse(content_of(dir + "/exit"))["signal"] == SIGTERM);
}

TEST_CASE("the shim explains a wrong command line") {
  for (const auto& arguments : std::vector<std::vector<std::string>>{
           {shim},
           {shim, "--dir", "/tmp/x", "--", "/bin/true"},
           {shim, "--dir", "/tmp/x", "--log-bytes", "4096", "--"},
           {shim, "--dir", "/tmp/x", "--log-bytes", "4k", "--", "/bin/true"},
           {shim, "--dir", "/tmp/x", "--log-bytes", "-1", "--", "/bin/true"},
           {shim, "--log-bytes", "4096", "--fence", "/f", "--", "/bin/true"},
           {shim, "--exit", "/e", "--dir", "/tmp/x", "--log-bytes", "4096",
            "--", "/bin/true"},
           {shim, "--fence", "/f", "--", "/bin/true"},
           {shim, "--stop-signal", "2", "--", "/bin/true"}}) {
    child_process process{arguments, {}};
    CHECK(process.wait() == 2);
    CHECK_THAT(process.output(), StartsWith("usage: "));
  }
  child_process process{{shim, "--dir", "/no/such/parent", "--log-bytes",
                         "4096", "--", "/bin/true"},
                        {}};
  CHECK(process.wait() == 1);
  CHECK_THAT(process.output(), Contains("/no/such/parent"));
}
