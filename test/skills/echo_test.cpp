#include "test/places.hpp"
#include "test/skills/child_process.hpp"
#include "test/skills/support.hpp"

#include <catch2/catch.hpp>

#include <nlohmann/json.hpp>

#include <csignal>

using namespace roscell::test;
using Catch::Matchers::Contains;
using nlohmann::json;

namespace {

const std::string folder_of_echo = roscell::test::build_dir() / "skills/echo";

child_process::variables variables_of(const temp_folder& folder,
                                      const json& options) {
  auto stream = [&](const char* name) {
    return json{{{"protocol", "file"},
                 {"endpoint", folder / name},
                 {"data_type", "text/plain"}}}
        .dump();
  };
  return {{"ROSCELL_MODEL", "plain"},
          {"ROSCELL_INPUTS", stream("in")},
          {"ROSCELL_OUTPUTS", stream("out")},
          {"ROSCELL_PARAMETERS", options.dump()},
          {"NOTIFY_SOCKET", folder / "notify"},
          {"WATCHDOG_USEC", "100000"}};
}

std::string echo() {
  return folder_of_echo + "/bin/echo";
}

} // namespace

TEST_CASE("echo repeats a growing file until it is told to stop") {
  temp_folder folder{"in", "one\ntwo\n"};
  notify_receiver node{folder / "notify"};
  child_process skill{{echo()}, variables_of(folder, {{"prefix", "> "}})};
  CHECK(node.receive() == "READY=1");
  CHECK(node.receive() == "READY=1\nWATCHDOG=1");
  folder.append("in", "three\n");
  CHECK(wait_in_folder(folder / "", [&] {
    return content_of(folder / "out") == "> one\n> two\n> three\n";
  }));
  CHECK_THAT(node.wait_for("STATUS=").value_or(""),
             Contains("READY=1\nWATCHDOG=1\nSTATUS=frames=3 dropped=0"));
  skill.signal(SIGTERM);
  CHECK_THAT(node.wait_for("STOPPING=1").value_or(""),
             Contains("frames=3 dropped=0 failed=0"));
  CHECK(skill.wait() == 0);
  CHECK(skill.output().empty());
}

TEST_CASE("echo lives on when somebody waits for it to be stop-safe") {
  temp_folder folder{"in", "one\n"};
  notify_receiver node{folder / "notify"};
  child_process skill{{echo()}, variables_of(folder, json::object())};
  CHECK(node.receive() == "READY=1");
  skill.signal(SIGUSR1);
  folder.append("in", "two\n");
  CHECK(wait_in_folder(
      folder / "", [&] { return content_of(folder / "out") == "one\ntwo\n"; }));
  skill.signal(SIGUSR1);
  skill.signal(SIGTERM);
  CHECK(skill.wait() == 0);
}

TEST_CASE("echo ends by itself when it is not to follow") {
  temp_folder folder;
  std::string lines;
  for (auto i = 0; i < 10'000; ++i)
    lines += std::to_string(i) + "\n";
  folder.write("in", lines);
  child_process skill{
      {echo()}, variables_of(folder, {{"follow", false}, {"queue_length", 1}})};
  CHECK(skill.wait() == 0);
  CHECK(content_of(folder / "out") == lines);
}

TEST_CASE("echo complains in one line when it cannot start") {
  temp_folder folder;
  child_process skill{{echo()}, variables_of(folder, json::object())};
  CHECK(skill.wait() == 2);
  CHECK_THAT(skill.output(), Contains("engine: cannot start: cannot read input")
                                 && Contains("No such file"));
  child_process bare{{echo()}, {}};
  CHECK(bare.wait() == 2);
  CHECK_THAT(bare.output(), Contains("ROSCELL_MODEL is not set"));
}

TEST_CASE("echo explains itself to a person") {
  child_process asked{{echo(), "--help"}, {}};
  CHECK(asked.wait() == 0);
  CHECK_THAT(asked.output(), Contains("models: plain"));
  child_process wrong{{echo(), "hello"}, {}};
  CHECK(wrong.wait() == 2);
}

TEST_CASE("the folder of echo is a complete skill") {
  auto descriptor = json::parse(content_of(folder_of_echo + "/skill.json"));
  CHECK(descriptor["operation"] == "echo");
  CHECK(descriptor["entry_point"] == json{"bin/echo"});
  CHECK(names_in(folder_of_echo)
        == std::vector<std::string>{"bin", "skill.json", "skill.version"});
  CHECK(names_in(folder_of_echo + "/bin") == std::vector<std::string>{"echo"});
}
