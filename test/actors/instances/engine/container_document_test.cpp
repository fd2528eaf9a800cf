#include "actors/instances/engine/container_document.hpp"
#include "test/actors/fakes/supervision_fakes.hpp"

#include <catch2/catch.hpp>

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <thread>

using namespace roscell;
using namespace roscell::test;
namespace fs = std::filesystem;

namespace {

start_container echo_request() {
  start_container order;
  order.instance = "i";
  order.image = "roscell/echo:1";
  order.command = {"bin/echo"};
  order.environment = {{"A", "1"}};
  order.labels = {{"task", "t"}, {"instance", "i"}, {"cell", "c"}};
  return order;
}

json document(const start_container& order, const container_files& files = {}) {
  return container_document(order, files, {"uuid", 1024 * 1024}, "/n",
                            {"/the/shim", "/the/exit", "/the/fence"});
}

io_endpoint file(const std::string& path) {
  return {"file", path, "text/plain"};
}

const container_mount* find(const container_files& files,
                            const std::string& target) {
  const auto& xs = files.mounts;
  const auto i = std::find_if(
      xs.begin(), xs.end(), [&](const auto& x) { return x.target == target; });
  return i != xs.end() ? &*i : nullptr;
}

container_files found_files(const start_container& order) {
  auto result = files_of(order);
  REQUIRE(std::holds_alternative<container_files>(result));
  return std::get<container_files>(std::move(result));
}

} // namespace

TEST_CASE("a container sees its secrets where engines have theirs, and cannot "
          "change them") {
  auto order = echo_request();
  order.environment["ROSCELL_SECRETS"] = "/run/roscell-secrets-1/i";
  order.secrets_folder = "/run/roscell-secrets-1/i";
  const auto x = document(order);
  CHECK(x["Env"]
        == json::array({"A=1", "NOTIFY_SOCKET=/run/roscell/notify",
                        "ROSCELL_SECRETS=/run/secrets"}));
  CHECK(x["HostConfig"]["Mounts"].back()
        == json{{"Type", "bind"},
                {"Source", "/run/roscell-secrets-1/i"},
                {"Target", "/run/secrets"},
                {"ReadOnly", true}});
}

TEST_CASE("a container shares network and memory, and is told where to speak") {
  const auto x = document(echo_request());
  CHECK(x["Image"] == "roscell/echo:1");
  CHECK(x["Env"] == json::array({"A=1", "NOTIFY_SOCKET=/run/roscell/notify"}));
  CHECK(x["User"]
        == std::to_string(::geteuid()) + ':' + std::to_string(::getegid()));
  CHECK(x["Labels"]
        == json{{"roscell.node", "uuid"},
                {"roscell.task", "t"},
                {"roscell.instance", "i"},
                {"roscell.cell", "c"}});
  const auto& host = x["HostConfig"];
  CHECK(host["NetworkMode"] == "host");
  CHECK(host["IpcMode"] == "host");
  CHECK(host["Mounts"]
        == json::array({{{"Type", "bind"},
                         {"Source", "/n"},
                         {"Target", "/run/roscell"},
                         {"ReadOnly", true}},
                        {{"Type", "bind"},
                         {"Source", "/the/shim"},
                         {"Target", "/opt/roscell/instance-shim"},
                         {"ReadOnly", true}},
                        {{"Type", "bind"},
                         {"Source", "/the/exit"},
                         {"Target", "/opt/roscell/exit"},
                         {"ReadOnly", false}}}));
  CHECK(host["LogConfig"]["Config"]["max-size"] == "524288");
  CHECK(host["LogConfig"]["Config"]["max-file"] == "2");
}

TEST_CASE("a container gets no more than it asked for") {
  auto order = echo_request();
  SECTION("without a request there is no limit") {
    const auto host = document(order)["HostConfig"];
    CHECK(host.count("Memory") == 0);
    CHECK(host.count("NanoCpus") == 0);
  }
  SECTION("memory has no swap beside it, and cores are parts of a core") {
    order.limits.memory_mib = 96.5;
    order.limits.cpu = 0.5;
    const auto host = document(order)["HostConfig"];
    CHECK(host["Memory"] == 97 * 1024 * 1024);
    CHECK(host["MemorySwap"] == host["Memory"]);
    CHECK(host["NanoCpus"] == 500'000'000);
  }
  SECTION("what an engine would refuse is rounded to what it takes") {
    order.limits.memory_mib = 1;
    order.limits.cpu = 1e6;
    const auto host = document(order)["HostConfig"];
    CHECK(host["Memory"] == 6 * 1024 * 1024);
    CHECK(host["NanoCpus"]
          == int64_t{std::thread::hardware_concurrency()} * 1'000'000'000);
  }
}

TEST_CASE("a container has nothing of root's power and gains none",
          "[powers]") {
  const auto x = document(echo_request());
  const auto& host = x["HostConfig"];
  CHECK(host["CapDrop"] == json::array({"ALL"}));
  CHECK(host["CapAdd"] == json::array());
  CHECK(host["SecurityOpt"] == json::array({"no-new-privileges"}));
  CHECK(host["ReadonlyRootfs"] == false);
  CHECK(host.count("Tmpfs") == 0);
}

TEST_CASE("a container has what is granted to its skill, by its shim",
          "[powers]") {
  auto order = echo_request();
  order.capabilities = {"NET_RAW", "KILL"};
  const auto x = document(order);
  CHECK(x["User"] == "0:0");
  CHECK(x["HostConfig"]["CapAdd"]
        == json::array({"DAC_OVERRIDE", "KILL", "NET_RAW", "SETGID", "SETPCAP",
                        "SETUID"}));
  const auto words = x["Entrypoint"].get<std::vector<std::string>>();
  const auto mask = std::find(words.begin(), words.end(), "--capabilities");
  REQUIRE(mask != words.end());
  // Numbers 5 and 13: the shim keeps the others to itself.
  CHECK(*std::next(mask) == "2020");
  order = echo_request();
  order.scheduling = {"fifo", 10, 0};
  const auto added = document(order)["HostConfig"]["CapAdd"];
  CHECK(std::count(added.begin(), added.end(), "SYS_NICE") == 1);
}

TEST_CASE("a container whose skill allows it writes nothing but /tmp",
          "[powers]") {
  auto order = echo_request();
  order.read_only = true;
  const auto host = document(order)["HostConfig"];
  CHECK(host["ReadonlyRootfs"] == true);
  CHECK(host["Tmpfs"].count("/tmp") == 1);
}

TEST_CASE("a container's limits never exceed those of its node") {
  const auto host = document(echo_request())["HostConfig"];
  REQUIRE(host["Ulimits"].size() == 2);
  rlimit own{};
  ::getrlimit(RLIMIT_NOFILE, &own);
  CHECK(host["Ulimits"][0]["Name"] == "nofile");
  CHECK(host["Ulimits"][0]["Soft"].get<rlim_t>() <= own.rlim_cur);
  CHECK(host["Ulimits"][0]["Hard"] == host["Ulimits"][0]["Soft"]);
  CHECK(host["Ulimits"][1]["Name"] == "nproc");
}

TEST_CASE("an instance with a GPU sees that one only, as its first") {
  auto order = echo_request();
  order.environment["CUDA_VISIBLE_DEVICES"] = "3";
  order.gpu = 3;
  const auto x = document(order);
  CHECK(x["Env"][1] == "CUDA_VISIBLE_DEVICES=0");
  const auto request = x["HostConfig"]["DeviceRequests"];
  REQUIRE(request.size() == 1);
  CHECK(request[0]["Driver"] == "nvidia");
  CHECK(request[0]["DeviceIDs"] == json::array({"3"}));
  CHECK(request[0]["Capabilities"] == json::array({json::array({"gpu"})}));
}

TEST_CASE("an instance without a GPU asks an engine for none") {
  CHECK(document(echo_request())["HostConfig"].count("DeviceRequests") == 0);
}

TEST_CASE("an engine without root has the node's user as its root") {
  container_setting setting{"uuid", 1024 * 1024};
  setting.rootless = true;
  CHECK(container_document(echo_request(), {}, setting, "/n", {})["User"]
        == "0:0");
}

TEST_CASE("a library path of the deployment does not hide the image's") {
  auto order = echo_request();
  order.environment["LD_LIBRARY_PATH"] = "/mine";
  CHECK(document(order)["Env"][1] == "LD_LIBRARY_PATH=/opt/roscell/lib:/mine");
}

TEST_CASE("a container runs its program under the shim") {
  auto order = echo_request();
  order.stop_signal = SIGINT;
  const bool of_base = GENERATE(false, true);
  order.command = {of_base ? "/bin/bash" : "bin/echo", "a"};
  const auto* program = of_base ? "/bin/bash" : "/opt/roscell/skill/bin/echo";
  json expected{"/opt/roscell/instance-shim", "--exit", "/opt/roscell/exit",
                "--stop-signal", "2"};
  SECTION("without a fence") {
    // nop
  }
  SECTION("with one") {
    order.fence_boot_ms = 1;
    expected.insert(expected.end(), {"--fence", "/opt/roscell/fence"});
    const auto mounts = document(order)["HostConfig"]["Mounts"];
    REQUIRE(mounts.size() == 4);
    CHECK(mounts[3]["Source"] == "/the/fence");
    CHECK(mounts[3]["Target"] == "/opt/roscell/fence");
    CHECK(mounts[3]["ReadOnly"] == true);
  }
  expected.insert(expected.end(), {"--capabilities", "0", "--", program, "a"});
  const auto x = document(order);
  CHECK(x["Entrypoint"] == expected);
  // The shim asks the program in the program's way.
  CHECK(x["StopSignal"] == "15");
}

TEST_CASE("inputs can be read, outputs written") {
  temp_folder folder;
  auto order = echo_request();
  const auto in = folder.write("in", "").string();
  const auto base = folder.path().string();
  order.input = {file(in), file(base + "/not/yet"), {"ros2", "/topic", "t"}};
  SECTION("what is there is mounted itself") {
    const auto out = folder.write("out", "x").string();
    order.output = {file(out)};
    const auto files = found_files(order);
    REQUIRE(find(files, in) != nullptr);
    CHECK(find(files, in)->read_only);
    REQUIRE(find(files, out) != nullptr);
    CHECK_FALSE(find(files, out)->read_only);
    CHECK(find(files, "/topic") == nullptr);
    CHECK(files.mounts.size() == 2);
  }
  SECTION("an output that is not there is made, as the skill would") {
    order.output = {file(base + "/new/out"), file(base + "/folder/")};
    const auto files = found_files(order);
    CHECK(fs::is_regular_file(base + "/new/out"));
    CHECK(fs::is_directory(base + "/folder"));
    CHECK(find(files, base + "/new/out") != nullptr);
    CHECK(find(files, base + "/folder") != nullptr);
  }
  SECTION("an input that is not there yet is seen by its folder") {
    order.input = {file(base + "/later")};
    const auto files = found_files(order);
    REQUIRE(find(files, base) != nullptr);
    CHECK(find(files, base)->read_only);
  }
  SECTION("what is both can be written") {
    order.output = {file(in)};
    CHECK_FALSE(find(found_files(order), in)->read_only);
  }
  SECTION("an output that cannot be made is a clear error") {
    order.output = {file(in + "/below")};
    const auto refused = files_of(order);
    REQUIRE(std::holds_alternative<edge_error>(refused));
    CHECK(std::get<edge_error>(refused).message.find(in + "/below")
          != std::string::npos);
  }
}

TEST_CASE("devices and volumes are the deployment's, a camera is a device") {
  auto order = echo_request();
  order.devices = {"/dev/gpiochip0"};
  order.volumes = {"/models:/opt/models:ro", "/scratch:/tmp/scratch/"};
  order.input = {{"video", "/dev/null", "image"}};
  const auto files = found_files(order);
  CHECK(files.devices
        == std::vector<std::string>{"/dev/null", "/dev/gpiochip0"});
  REQUIRE(find(files, "/opt/models") != nullptr);
  CHECK(find(files, "/opt/models")->source == "/models");
  CHECK(find(files, "/opt/models")->read_only);
  REQUIRE(find(files, "/tmp/scratch") != nullptr);
  CHECK_FALSE(find(files, "/tmp/scratch")->read_only);
  const auto host = document(order, files)["HostConfig"];
  CHECK(host["Devices"].size() == 2);
  CHECK(host["Devices"][0]["PathOnHost"] == "/dev/null");
}

namespace {

start_container podman_request() {
  auto order = echo_request();
  order.environment = {{"A", "1=2"}};
  order.labels = {{"task", "t"}};
  return order;
}

json podman_form(const start_container& order,
                 const container_files& files = {}) {
  return podman_document("roscell-i", document(order, files));
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
