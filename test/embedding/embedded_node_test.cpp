#include "test/embedding/embedding_fixture.hpp"

#include "roscell/client.hpp"

#include <csignal>
#include <fstream>
#include <future>
#include <map>
#include <thread>

#include <sched.h>

using namespace roscell;
using namespace roscell::test;

namespace {

std::size_t entries_of(const char* folder) {
  const auto at = std::filesystem::directory_iterator{folder};
  return static_cast<std::size_t>(std::distance(begin(at), end(at)));
}

std::string code_of(const std::function<void()>& start) {
  try {
    start();
  } catch (const node_error& error) {
    return error.code();
  }
  return "";
}

/// What /proc/self/task/ID/status says of each thread, by its id.
std::map<std::string, std::string> threads(const std::string& key) {
  std::map<std::string, std::string> result;
  for (const auto& x : std::filesystem::directory_iterator{"/proc/self/task"}) {
    std::ifstream status{x.path() / "status"};
    for (std::string line; std::getline(status, line);)
      if (line.rfind(key + ":\t", 0) == 0)
        result[x.path().filename()] = line.substr(key.size() + 2);
  }
  return result;
}

/// The last core that this program may use.
unsigned last_core() {
  cpu_set_t allowed;
  REQUIRE(::sched_getaffinity(0, sizeof(allowed), &allowed) == 0);
  unsigned result = 0;
  for (unsigned i = 0; i < CPU_SETSIZE; ++i)
    if (CPU_ISSET(i, &allowed))
      result = i;
  return result;
}

} // namespace

TEST_CASE("a node starts, answers and ends within a program") {
  temp_folder folder;
  embedded_node node{setup_in(folder.path())};
  CHECK(node.facts().name == "controller");
  const auto said = asker{node}.ask({{"type", "node_query"}});
  CHECK(said.at("identity").at("name") == "controller");
  CHECK(node.stop());
  CHECK(node.has_ended());
}

TEST_CASE("two nodes of one program cannot share a data directory") {
  temp_folder folder;
  const auto setup = setup_in(folder.path());
  embedded_node node{setup};
  CHECK(code_of([&] { embedded_node{setup}; }) == "conflict");
  CHECK_FALSE(node.has_ended());
}

TEST_CASE("several nodes live in one program, each with its own cell") {
  temp_folder one;
  temp_folder two;
  auto other = setup_in(two.path());
  other.node.name = "other";
  embedded_node first{setup_in(one.path())};
  embedded_node second{other};
  CHECK(asker{first}.ask({{"type", "node_query"}}).at("cell") == "controller");
  CHECK(asker{second}.ask({{"type", "node_query"}}).at("cell") == "other");
}

TEST_CASE("a node lives in the program's own actor system, too") {
  temp_folder folder;
  caf::actor_system_config config;
  caf::actor_system system{config};
  embedded_node node{system, setup_in(folder.path())};
  CHECK(asker{node}.ask({{"type", "node_query"}}).at("identity").at("name")
        == "controller");
}

TEST_CASE("an environment that would mislead DDS is refused, and stays as it "
          "is") {
  temp_folder folder;
  ::setenv("ROS_DISCOVERY_SERVER", "10.0.0.1:11811", 1);
  const auto code = code_of([&] { embedded_node{setup_in(folder.path())}; });
  const std::string after = std::getenv("ROS_DISCOVERY_SERVER");
  ::unsetenv("ROS_DISCOVERY_SERVER");
  CHECK(code == "conflict");
  CHECK(after == "10.0.0.1:11811");
}

TEST_CASE("threads of a node run on its cores only and take no signals") {
  temp_folder folder;
  const auto before = threads("Cpus_allowed_list");
  auto setup = setup_in(folder.path());
  setup.threads.cpus = {last_core()};
  embedded_node node{setup};
  CHECK(threads("Cpus_allowed_list").size() > 5);
  for (const auto& [thread, cores] : threads("Cpus_allowed_list"))
    if (before.count(thread) == 0)
      CHECK(cores == std::to_string(last_core()));
  for (const auto& [thread, blocked] : threads("SigBlk"))
    if (before.count(thread) == 0)
      for (const int signal : {SIGINT, SIGTERM, SIGCHLD, SIGPIPE, SIGUSR1})
        CHECK((std::stoull(blocked, nullptr, 16) >> (signal - 1) & 1) == 1);
}

TEST_CASE("a core that is not there is refused") {
  temp_folder folder;
  auto setup = setup_in(folder.path());
  setup.threads.cpus = {1000};
  CHECK(code_of([&] { embedded_node{setup}; }) == "schema_violation");
}

namespace {

void start_and_stop() {
  temp_folder folder;
  embedded_node node{setup_in(folder.path())};
  REQUIRE(node.stop());
}

/// Resident memory of this process, in pages.
long resident_pages() {
  long size = 0;
  long resident = 0;
  std::ifstream{"/proc/self/statm"} >> size >> resident;
  return resident;
}

} // namespace

TEST_CASE("starting and stopping again and again leaves nothing behind") {
  // What libraries make once is made.
  start_and_stop();
  const auto files = entries_of("/proc/self/fd");
  const auto tasks = entries_of("/proc/self/task");
  for (int i = 0; i < 10; ++i)
    start_and_stop();
  CHECK(entries_of("/proc/self/fd") == files);
  CHECK(entries_of("/proc/self/task") == tasks);
}

// By hand, without sanitizers: test_embedding "[hundred]".
TEST_CASE("a hundred starts and stops take no memory", "[.][hundred]") {
  for (int i = 0; i < 20; ++i)
    start_and_stop();
  const auto before = resident_pages();
  for (int i = 0; i < 100; ++i)
    start_and_stop();
  const auto grown_kib = (resident_pages() - before) * 4;
  WARN("grown by " << grown_kib << " KiB");
  CHECK(grown_kib < 1024);
}

TEST_CASE("a client asks a node, and is told when it goes away") {
  temp_folder folder;
  auto node = std::make_unique<embedded_node>(setup_in(folder.path()));
  const client from_outside{{node->facts().socket, "", 0, ""}};
  CHECK(json::parse(from_outside.get("/v1/node")).at("identity").at("name")
        == "controller");
  std::string code;
  CHECK_THROWS_AS(from_outside.get("/v1/nowhere"), client_error);
  std::promise<void> first_event;
  std::thread watcher{[&, reported = false]() mutable {
    try {
      from_outside.follow_events(0, [&](const node_event&) {
        if (!std::exchange(reported, true))
          first_event.set_value();
        return true;
      });
    } catch (const client_error& error) {
      code = error.code();
    }
  }};
  auto heard = first_event.get_future();
  CHECK(heard.wait_for(std::chrono::seconds{30}) == std::future_status::ready);
  node.reset();
  watcher.join();
  CHECK((code.empty() || code == "unreachable"));
  CHECK_THROWS_AS(from_outside.get("/v1/node"), client_error);
}
