#include "tools/roscell/config/node_options.hpp"

#include "tools/roscell/client/target.hpp"
#include "tools/roscell/commands.hpp"
#include "tools/roscell/exit_code.hpp"

#include <CLI/CLI.hpp>
#include <catch2/catch.hpp>

#include <string>
#include <vector>

using namespace roscell;
using namespace roscell::cli;
namespace fs = std::filesystem;

namespace {

/// Whether the whole command line takes these words.
bool parses(std::vector<std::string> words) {
  CLI::App app;
  action chosen;
  set_up(app, chosen);
  try {
    // CLI11 takes the words last first.
    app.parse(std::vector<std::string>{words.rbegin(), words.rend()});
    return static_cast<bool>(chosen);
  } catch (const CLI::ParseError&) {
    return false;
  }
}

std::string refusal(const node_options& options) {
  try {
    to_config(options);
    return {};
  } catch (const command_error& e) {
    CHECK(e.code == exit_usage);
    return e.what();
  }
}

} // namespace

TEST_CASE("every default of a node comes from one data directory", "[tools]") {
  const auto config = to_config({});
  CHECK(config.data_dir == default_data_dir());
  CHECK(config.socket == config.data_dir / "node.sock");
  CHECK(config.skill_dirs.empty()); // The node adds its own.
  CHECK(config.log_bytes == 1024 * 1024);
  CHECK(config.history_bytes == 64 * 1024 * 1024);
  CHECK(config.history_age == std::chrono::hours{7 * 24});
  CHECK(config.http_port == 8420);
  CHECK(config.discovery_port == 11811);
}

TEST_CASE("a node's paths are absolute", "[tools]") {
  node_options options;
  options.config.data_dir = "data";
  options.config.socket = "s";
  options.skill_dirs = {"mine"};
  const auto config = to_config(options);
  CHECK(config.data_dir == fs::current_path() / "data");
  CHECK(config.socket == fs::current_path() / "s");
  CHECK(config.skill_dirs == std::vector{fs::current_path() / "mine"});
}

TEST_CASE("labels are split at the first equals sign", "[tools]") {
  node_options options;
  options.labels = {"room=lab", "formula=a=b", "empty="};
  const auto labels = to_config(options).labels;
  CHECK(labels.at("room") == "lab");
  CHECK(labels.at("formula") == "a=b");
  CHECK(labels.at("empty").empty());
}

TEST_CASE("a label that is none or given twice is refused", "[tools]") {
  for (const auto* label : {"room", "=lab", ""}) {
    node_options options;
    options.labels = {label};
    CHECK(refusal(options).find("--label") == 0);
  }
  node_options twice;
  twice.labels = {"room=lab", "room=hall"};
  CHECK(refusal(twice) == "--label: 'room' is given twice");
}

TEST_CASE("the bound of a log has bounds itself", "[tools]") {
  for (const auto* size : {"1", "2GiB", "1MB", ""}) {
    node_options options;
    options.log_bytes = size;
    CHECK(refusal(options).find("--log-bytes") == 0);
  }
}

TEST_CASE("the bounds of the history have bounds themselves", "[tools]") {
  for (const auto* size : {"1MiB", "2TiB", ""}) {
    node_options options;
    options.history_bytes = size;
    CHECK(refusal(options).find("--history-bytes") == 0);
  }
  for (const auto* age : {"59m", "7", "-1d", "", "40000d"}) {
    node_options options;
    options.history_age = age;
    CHECK(refusal(options).find("--history-age") == 0);
  }
  node_options options;
  options.history_bytes = "2MiB";
  options.history_age = "36h";
  const auto config = to_config(options);
  CHECK(config.history_bytes == 2 * 1024 * 1024);
  CHECK(config.history_age == std::chrono::hours{36});
}

TEST_CASE("a coordinator joins nothing, and only it names a cell", "[tools]") {
  node_options joining;
  joining.config.coordinator = true;
  joining.config.join = "10.0.0.1";
  CHECK_FALSE(refusal(joining).empty());
  node_options named;
  named.config.cell = "lab";
  CHECK_FALSE(refusal(named).empty());
  named.config.coordinator = true;
  CHECK(refusal(named).empty());
}

TEST_CASE("only a coordinator has a name to take and a cell to balance",
          "[tools]") {
  node_options forcing;
  forcing.config.force = true;
  CHECK(refusal(forcing).find("--force") == 0);
  node_options keeping;
  keeping.config.rebalance = false;
  CHECK(refusal(keeping).find("--no-rebalance") == 0);
  node_options open;
  open.config.ros2_set_parameters = true;
  CHECK(refusal(open).find("--ros2-set-parameters") == 0);
  open.config.coordinator = true;
  CHECK(refusal(open).empty());
  forcing.config.coordinator = keeping.config.coordinator = true;
  CHECK(refusal(forcing).empty());
  CHECK(refusal(keeping).empty());
}

TEST_CASE("a node that waits neither joins nor coordinates", "[tools]") {
  node_options waiting;
  waiting.config.wait = true;
  CHECK(refusal(waiting).empty());
  auto joining = waiting;
  joining.config.join = "10.0.0.1";
  CHECK(refusal(joining).find("--wait") != std::string::npos);
  auto coordinating = waiting;
  coordinating.config.coordinator = true;
  CHECK(refusal(coordinating) != "");
}

TEST_CASE("a peer is an IPv4 address or a name, with or without a port",
          "[tools]") {
  node_options options;
  options.config.peers = {"10.0.0.1", "10.0.0.2:7410", "robot",
                          "base.local:7410"};
  CHECK(refusal(options).empty());
  for (const auto* peer : {"", "-robot", "10.0.0", "10.0.0.1:", "10.0.0.1:0",
                           "10.0.0.1:65536", "10.0.0.1:80x", "::1"}) {
    options.config.peers = {"10.0.0.1", peer};
    CHECK(refusal(options).find("--peer: '" + std::string{peer} + "'") == 0);
  }
}

TEST_CASE("a device is one that this machine has", "[tools]") {
  node_options options;
  options.config.devices = {"/dev/null"};
  CHECK(refusal(options).empty());
  for (const auto* path :
       {"/dev/video1234", "/dev/null/x", "", "/dev", "/etc/hosts"}) {
    options.config.devices = {"/dev/null", path};
    CHECK(refusal(options).find("--device: ") == 0);
  }
  CHECK(refusal(options) == "--device: '/etc/hosts' is no device");
}

TEST_CASE("a grant names what there is", "[tools][grants]") {
  CHECK(parses({"node", "--grant", "ping=capability:NET_RAW,capability:KILL",
                "--grant", "*=scheduling:fifo:20"}));
  CHECK(parses({"node", "--grant", "ping=user:root"}));
  CHECK_FALSE(parses({"node", "--grant", "ping=user:nobody-of-that-name"}));
  CHECK_FALSE(parses({"node", "--grant", "ping=capability:CAP_NET_RAW"}));
  CHECK_FALSE(parses({"node", "--grant", "ping"}));
}

TEST_CASE("the command line takes what the design names", "[tools]") {
  CHECK(parses({"node",
                "--name",
                "a",
                "--coordinator",
                "--cell",
                "c",
                "--interface",
                "lo",
                "--port",
                "0",
                "--discovery-port",
                "0",
                "--server-id",
                "255",
                "--domain-id",
                "232",
                "--runtime",
                "process",
                "--data-dir",
                "/d",
                "--socket",
                "/s",
                "--skills",
                "/k",
                "--skills",
                "/l",
                "--site-token",
                "/t",
                "--capacity",
                "cpu=2,memory_mib=512",
                "--label",
                "a=b",
                "--label",
                "c=d",
                "--device",
                "/dev/video0",
                "--log-level",
                "debug",
                "--log-bytes",
                "64KiB",
                "--history-bytes",
                "8MiB",
                "--history-age",
                "30d",
                "--ready-fd",
                "3"}));
  CHECK(parses({"node", "--join", "10.0.0.1:11811", "--interface", "lo"}));
  CHECK(parses({"node", "--wait", "--peer", "10.0.0.1", "--peer", "10.0.0.2",
                "--public-domain", "232"}));
  CHECK(parses({"node", "--coordinator", "--no-rebalance", "--force",
                "--ros2-set-parameters"}));
  CHECK(parses({"form", "a", "b", "--instances", "reschedule"}));
  CHECK(parses({"transfer", "a", "hall", "--timeout", "1m", "-o", "json"}));
  CHECK(parses({"release", "--instances", "terminate", "a"}));
  CHECK(parses({"transfers", "--watch"}));
  CHECK(parses({"transfers", "lab-1-1", "-o", "json"}));
  CHECK(parses({"request"}));
  CHECK(parses({"request", "-"}));
  CHECK(parses({"request", "--to", "unix:/s", "--timeout", "2m", "f"}));
  CHECK(parses({"plan", "f", "-o", "json"}));
  for (const auto* name :
       {"status", "cells", "nodes", "tasks", "instances", "skills"})
    CHECK(parses({name, "-o", "json", "--watch", "--to", "host:1"}));
  CHECK(parses({"tasks", "fleet-poses"}));
  CHECK(parses({"events", "--since", "0", "-n", "5", "-o", "table"}));
  CHECK(parses({"logs", "-f", "--tail", "20", "t-a-1"}));
  CHECK(parses({"node", "--runtime", "docker:/run/docker.sock"}));
  CHECK(parses({"completion", "bash"}));
}

TEST_CASE("the command line refuses what cannot be meant", "[tools]") {
  CHECK_FALSE(parses({}));
  CHECK_FALSE(parses({"nonsense"}));
  CHECK_FALSE(parses({"status", "tasks"}));
  CHECK_FALSE(parses({"status", "extra"}));
  CHECK_FALSE(parses({"status", "-o", "xml"}));
  CHECK_FALSE(parses({"node", "--port", "65536"}));
  CHECK_FALSE(parses({"node", "--server-id", "256"}));
  CHECK_FALSE(parses({"node", "--domain-id", "233"}));
  CHECK_FALSE(parses({"node", "--public-domain", "233"}));
  CHECK_FALSE(parses({"form"}));
  CHECK_FALSE(parses({"form", "a", "--instances", "keep"}));
  CHECK_FALSE(parses({"transfer", "a"}));
  CHECK_FALSE(parses({"transfer", "a", "b", "c"}));
  CHECK_FALSE(parses({"release"}));
  CHECK_FALSE(parses({"release", "a", "b"}));
  CHECK_FALSE(parses({"node", "--runtime", "podmann"}));
  CHECK_FALSE(parses({"node", "--runtime", "process:/s"}));
  CHECK_FALSE(parses({"node", "--runtime", "docker:"}));
  CHECK_FALSE(parses({"node", "--runtime", "docker:relative"}));
  CHECK_FALSE(parses({"request", "--timeout", "0", "f"}));
  CHECK_FALSE(parses({"request", "a", "b"}));
  CHECK_FALSE(parses({"plan"}));
  CHECK_FALSE(parses({"logs"}));
  CHECK(parses({"logs", "--previous"}));
  CHECK_FALSE(parses({"logs", "--tail", "0", "x"}));
  CHECK_FALSE(parses({"events", "--since", "-1"}));
  CHECK_FALSE(parses({"completion", "tcsh"}));
}
