#include "test/embedding/embedding_fixture.hpp"

#include <condition_variable>
#include <mutex>
#include <thread>

using namespace roscell;
using namespace roscell::test;

namespace {

constexpr std::chrono::seconds patience{30};
/// Less than a question waits that has nothing new to be told.
constexpr std::chrono::seconds at_once{10};

/// What was heard, on whatever thread.
class heard_status {
public:
  void add(const std::string& word) {
    {
      const std::lock_guard<std::mutex> lock{mutex_};
      words_.push_back(word);
    }
    changed_.notify_all();
  }

  /// Whether it has come, or comes in time.
  bool has(const std::string& word, std::chrono::seconds limit = patience) {
    std::unique_lock<std::mutex> lock{mutex_};
    return changed_.wait_for(lock, limit, [&] {
      return std::find(words_.begin(), words_.end(), word) != words_.end();
    });
  }

private:
  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<std::string> words_;
};

/// A coordinator with one skill, whose instances run until they are stopped.
node_setup setup_with_skill(const std::filesystem::path& folder) {
  auto result = setup_in(folder);
  result.skills = {
      {descriptor_of("rest"),
       [](actor_skill_instance::pointer, const actor_skill_context& context)
           -> actor_skill_instance::behavior_type {
         context.ready();
         return {
             [](const skill_frame&) {},
             [](check_life) {},
             [](stop_skill) {},
         };
       }}};
  return result;
}

constexpr const char* rest = R"(
task: t
pipeline:
  - id: s
    operation: rest
    model: plain
    input: {protocol: actor, endpoint: /b, data_type: text/plain}
    output: {protocol: actor, endpoint: /a, data_type: text/plain}
  - id: r
    operation: rest
    model: plain
    input: {protocol: actor, endpoint: /a, data_type: text/plain}
    output: {protocol: actor, endpoint: /b, data_type: text/plain}
)";

std::string code_of_call(const std::function<void()>& call) {
  try {
    call();
  } catch (const node_error& error) {
    return error.code();
  }
  return "";
}

} // namespace

TEST_CASE("a program hears events and log of its node by plain calls") {
  temp_folder folder;
  heard_status events;
  heard_status lines;
  auto setup = setup_in(folder.path());
  setup.calls.on_event = [&](const node_event& x) {
    events.add(x.what + " " + x.subject);
    throw std::runtime_error{"which holds nobody up"};
  };
  setup.calls.on_log = [&](log_level level, const std::string& line) {
    if (level == log_level::info)
      lines.add(line.substr(0, line.find(" address=")));
  };
  SECTION("each event") {
    embedded_node node{setup};
    CHECK(events.has("node_started controller"));
    CHECK(node.stop());
  }
  SECTION("each line") {
    setup.calls.on_event = nullptr;
    embedded_node node{setup};
    CHECK(lines.has("node_started 'controller'"));
    CHECK(node.stop());
  }
}

TEST_CASE("a program hears what keeps its node from its cell") {
  temp_folder folder;
  heard_status problems;
  auto setup = setup_in(folder.path());
  setup.node.coordinator = false;
  // Nobody listens there.
  setup.node.join = "127.0.0.1:9";
  setup.calls.on_join_problem = [&](const join_problem& x) {
    problems.add(x.where + (x.reason.empty() ? " joined" : " trouble"));
  };
  embedded_node node{setup};
  CHECK(problems.has("127.0.0.1:9 trouble"));
}

TEST_CASE("a program runs, asks, watches and stops a task by plain calls") {
  temp_folder folder;
  heard_status states;
  embedded_node node{setup_with_skill(folder.path())};
  const auto watch = node.watch(
      "t", [&](const task_status& x) { states.add(x.task + " " + x.state); });
  CHECK(states.has("t gone"));
  const auto status = node.run(rest);
  CHECK(status.state == "running");
  REQUIRE(status.steps.size() == 2);
  for (const auto& step : status.steps) {
    CHECK(step.node == "controller");
    CHECK(step.state == "running");
  }
  CHECK(node.state("t") == status);
  CHECK(states.has("t running"));
  node.stop("t");
  CHECK(node.state("t").state == "gone");
}

TEST_CASE("a program at a member hears of each change elsewhere at once") {
  temp_folder folder;
  embedded_node base{setup_with_skill(folder.path())};
  // Both are of one user, who has one site token.
  auto setup = setup_in(folder.path());
  setup.node.data_dir = folder.path() / "arm";
  setup.node.name = "arm";
  setup.node.coordinator = false;
  setup.node.join = base.facts().discovery_server;
  heard_status problems;
  setup.calls.on_join_problem = [&](const join_problem& x) {
    problems.add(x.reason.empty() ? "joined" : x.reason);
  };
  heard_status states;
  embedded_node member{setup};
  REQUIRE(problems.has("joined"));
  const auto watch = member.watch(
      "t", [&](const task_status& x) { states.add(x.task + " " + x.state); });
  CHECK(states.has("t gone"));
  base.run(rest);
  CHECK(states.has("t running", at_once));
  CHECK(member.state("t").state == "running");
  member.stop("t");
  CHECK(states.has("t terminating", at_once));
  CHECK(base.state("t").state == "gone");
}

TEST_CASE("a watch at a member goes on when its coordinator is back") {
  temp_folder folder;
  heard_status states;
  auto coordinator = setup_with_skill(folder.path());
  auto base = std::make_unique<embedded_node>(coordinator);
  const auto server = base->facts().discovery_server;
  auto setup = setup_in(folder.path());
  setup.node.data_dir = folder.path() / "arm";
  setup.node.name = "arm";
  setup.node.coordinator = false;
  setup.node.join = server;
  embedded_node member{setup};
  // It may be in no cell yet, which a watch waits for, too.
  const auto watch = member.watch(
      "t", [&](const task_status& x) { states.add(x.task + " " + x.state); });
  CHECK(states.has("t gone"));
  base.reset();
  coordinator.node.discovery_port =
      static_cast<uint16_t>(std::stoi(server.substr(server.rfind(':') + 1)));
  base = std::make_unique<embedded_node>(coordinator);
  base->run(rest);
  CHECK(states.has("t running"));
}

TEST_CASE("a program hears that its node lacks the site token") {
  temp_folder folder;
  embedded_node base{setup_in(folder.path())};
  heard_status problems;
  const auto other = folder.path() / "other";
  std::filesystem::create_directory(other);
  auto setup = setup_in(other);
  setup.node.name = "arm";
  setup.node.coordinator = false;
  setup.node.join = base.facts().discovery_server;
  setup.calls.on_join_problem = [&](const join_problem& x) {
    problems.add((x.reason + x.hint).find("site token") != std::string::npos
                     ? "no token"
                     : x.reason);
  };
  embedded_node member{setup};
  CHECK(problems.has("no token"));
}

TEST_CASE("a plain call that is refused throws with the code of the refusal") {
  temp_folder folder;
  embedded_node node{setup_in(folder.path())};
  CHECK(code_of_call([&] { node.run(rest); }) == "unknown_operation");
  CHECK(code_of_call([&] { node.run("pipeline: ["); }) == "malformed_json");
  CHECK(code_of_call([&] { node.stop("t"); }) == "unknown_task");
  CHECK(node.state("t").state == "gone");
}

TEST_CASE("a watch may be ended by its own call, and makes no other one") {
  temp_folder folder;
  embedded_node node{setup_in(folder.path())};
  std::mutex mutex;
  std::unique_ptr<task_watch> watch;
  heard_status calls;
  {
    const std::lock_guard<std::mutex> lock{mutex};
    watch =
        std::make_unique<task_watch>(node.watch("t", [&](const task_status&) {
          const std::lock_guard<std::mutex> inner{mutex};
          watch.reset();
          calls.add("ended");
        }));
  }
  CHECK(calls.has("ended"));
  CHECK(node.stop());
}
