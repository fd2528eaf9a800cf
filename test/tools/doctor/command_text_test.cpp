#include "actors/edge/process/process_spawner.hpp"
#include "tools/roscell/doctor/cell/cell_findings.hpp"
#include "tools/roscell/doctor/command_text.hpp"
#include "tools/roscell/doctor/node/camera_checks.hpp"
#include "tools/roscell/doctor/node/node_checks.hpp"

#include <catch2/catch.hpp>

using namespace roscell;
using namespace roscell::cli;
using Catch::Contains;

namespace {

/// What a command has said, with programs of these names that say what they
/// were given.
std::string said_by(const std::string& command) {
  constexpr std::chrono::seconds patience{5};
  constexpr size_t most_bytes = 4096;
  const auto said = run_program({"/bin/sh",
                                 {"-c", "roscell() { printf '%s\n' \"$@\"; }; "
                                        "ssh() { shift 2; eval \"$@\"; }; "
                                            + command},
                                 {}},
                                patience, most_bytes);
  return std::get<std::string>(said);
}

const std::vector<std::string> hostile_words{"$(echo run)",
                                             "`echo run`",
                                             "a;echo run",
                                             "'; echo run; '",
                                             "a\necho run",
                                             "*",
                                             "~",
                                             "a b",
                                             "",
                                             "\\"};

} // namespace

TEST_CASE("no name is more than a word to the shell", "[doctor]") {
  for (const auto& word : hostile_words) {
    const auto command = "roscell " + shell_word(word);
    CHECK(said_by(command) == word + "\n");
    CHECK(said_by(on_host("10.0.0.2", command)) == word + "\n");
  }
  CHECK(shell_word("/dev/shm/fastrtps_port7411")
        == "/dev/shm/fastrtps_port7411");
}

TEST_CASE("an address that is none is no option of ssh", "[doctor]") {
  CHECK(on_host("10.0.0.2", "sudo reboot") == "ssh -t 10.0.0.2 'sudo reboot'");
  for (const auto* address : {"-oProxyCommand=x", "$(x)", "", "a b"})
    CHECK(on_host(address, "id") == "ssh -t ADDRESS id");
}

TEST_CASE("what ROS 2 programs and nodes call themselves is not run",
          "[doctor]") {
  for (const auto& word : hostile_words) {
    topic_row topic;
    topic.topic = word;
    CHECK(said_by(judge_camera(topic, std::nullopt).remedy)
          == "echo\n" + word + "\n--count\n1\n");
    cell_description cell;
    cell.nodes.resize(1);
    cell.nodes[0].state = row_state::lost;
    cell.nodes[0].identity.name = word;
    CHECK(said_by(judge_cell(cell)[0].remedy)
          == "describe\nnode\n" + word + "\n");
  }
}

TEST_CASE("an address that a node tells of itself is not run", "[doctor]") {
  reached_cell cell;
  cell.coordinator = "head";
  cell.nodes["head"] = {"head", "1.0", "10.0.0.1:8420", "", 7491, 0};
  cell.nodes["arm"] = {"arm", "0.9", "$(echo run)", "", 7491, 0};
  CHECK(judge_versions(cell)[0].remedy == "ssh -t ADDRESS 'roscell --version'");
}
