#include "actors/instances/engine/container_document.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <csignal>

#include <unistd.h>

using namespace roscell;

namespace {

start_container podman_request() {
  start_container order;
  order.instance = "i";
  order.image = "roscell/echo:1";
  order.command = {"bin/echo"};
  order.environment = {{"A", "1=2"}};
  order.labels = {{"task", "t"}};
  return order;
}

json podman_form(const start_container& order,
                 const container_files& files = {}) {
  return podman_document(
      "roscell-i",
      container_document(order, files, {"uuid", 1024 * 1024}, "/n",
                         {"/the/shim", "/the/exit", "/the/fence"}));
}

} // namespace

TEST_CASE("Podman is told of the same container in its own words") {
  const auto x = podman_form(
      podman_request(),
      {{{"/in", "/in", true}, {"/out", "/o", false}}, {"/dev/video0"}});
  CHECK(x["name"] == "roscell-i");
  CHECK(x["image"] == "roscell/echo:1");
  CHECK(x["user"]
        == std::to_string(::geteuid()) + ':' + std::to_string(::getegid()));
  CHECK(x["env"]
        == json{{"A", "1=2"}, {"NOTIFY_SOCKET", "/run/roscell/notify"}});
  CHECK(x["labels"] == json{{"roscell.node", "uuid"}, {"roscell.task", "t"}});
  CHECK(x["netns"]["nsmode"] == "host");
  CHECK(x["ipcns"]["nsmode"] == "host");
  REQUIRE(x["mounts"].size() == 5);
  CHECK(x["mounts"][1]
        == json{{"type", "bind"},
                {"source", "/in"},
                {"destination", "/in"},
                {"options", {"rbind", "ro"}}});
  CHECK(x["mounts"][2]["destination"] == "/o");
  CHECK(x["mounts"][2]["options"] == json::array({"rbind", "rw"}));
  CHECK(x["devices"]
        == json::array({{{"path", "/dev/video0:/dev/video0:rwm"}}}));
  CHECK(x["r_limits"][0]["type"] == "nofile");
  CHECK(x["r_limits"][1]["type"] == "nproc");
  CHECK(x["log_configuration"]["size"] == 524288);
  CHECK(x["resource_limits"] == json::object());
}

TEST_CASE("Podman counts cores in a quota and memory in bytes") {
  auto order = podman_request();
  order.limits.cpu = 0.5;
  order.limits.memory_mib = 96;
  const auto limits = podman_form(order)["resource_limits"];
  CHECK(limits["cpu"] == json{{"period", 100'000}, {"quota", 50'000}});
  CHECK(limits["memory"]["limit"] == 96 * 1024 * 1024);
  CHECK(limits["memory"]["swap"] == limits["memory"]["limit"]);
}

TEST_CASE("Podman is told of a program of the base image and how it ends") {
  auto order = podman_request();
  order.command = {"/bin/bash", "-c", "true"};
  order.stop_signal = SIGINT;
  const auto x = podman_form(order);
  CHECK(x["entrypoint"]
        == json{"/opt/roscell/instance-shim", "--exit", "/opt/roscell/exit",
                "--stop-signal", "2", "--capabilities", "0", "--", "/bin/bash",
                "-c", "true"});
  CHECK(x["stop_signal"] == SIGTERM);
}

TEST_CASE("Podman is told of the same fence") {
  auto order = podman_request();
  order.fence_boot_ms = 1;
  const auto x = podman_form(order);
  CHECK(x["entrypoint"][0] == "/opt/roscell/instance-shim");
  REQUIRE(x["mounts"].size() == 4);
  CHECK(x["mounts"][3]
        == json{{"type", "bind"},
                {"source", "/the/fence"},
                {"destination", "/opt/roscell/fence"},
                {"options", {"rbind", "ro"}}});
}

TEST_CASE("Podman is asked for a GPU by its CDI name") {
  auto order = podman_request();
  order.gpu = 3;
  const auto x = podman_form(order);
  CHECK(x["devices"] == json::array({{{"path", "nvidia.com/gpu=3"}}}));
  CHECK(x["env"]["CUDA_VISIBLE_DEVICES"] == "0");
}

TEST_CASE("Podman is told what a container may not, in its own words",
          "[powers]") {
  auto order = podman_request();
  CHECK(podman_form(order)["cap_drop"] == json::array({"ALL"}));
  CHECK(podman_form(order)["cap_add"] == json::array());
  CHECK(podman_form(order)["no_new_privileges"] == true);
  CHECK(podman_form(order)["read_only_filesystem"] == false);
  order.capabilities = {"NET_RAW"};
  order.read_only = true;
  const auto x = podman_form(order);
  const auto added = x["cap_add"].get<std::vector<std::string>>();
  CHECK(std::count(added.begin(), added.end(), "NET_RAW") == 1);
  CHECK(x["read_only_filesystem"] == true);
  CHECK(x["mounts"].back()
        == json{{"type", "tmpfs"},
                {"source", "tmpfs"},
                {"destination", "/tmp"},
                {"options", {"rw", "nosuid", "nodev", "mode=1777"}}});
}
