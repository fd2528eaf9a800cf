#include "test/embedding/embedding_fixture.hpp"

#include <atomic>
#include <future>
#include <stdexcept>

using namespace roscell;
using namespace roscell::test;

namespace {

using behavior = actor_skill_instance::behavior_type;
using pointer = actor_skill_instance::pointer;
using context_type = actor_skill_context;

void give_go(const context_type& context) {
  engine::frame out;
  out.payload = "go";
  context.emit(std::move(out));
}

/// Gives the frame "go" once it is ready, and again with every sign of life:
/// who reads it may have come later.
behavior source(pointer, const context_type& context) {
  context.ready();
  give_go(context);
  return {
      [](const skill_frame&) {},
      [context](check_life) { give_go(context); },
      [](stop_skill) {},
  };
}

json step(const std::string& id, const std::string& operation,
          const json& input, const json& output) {
  return {{"id", id},
          {"operation", operation},
          {"model", "plain"},
          {"input", input},
          {"output", output}};
}

json task_of(const json& steps) {
  return {{"type", "task_request"}, {"task", "t"}, {"pipeline", steps}};
}

/// A node with one skill beside a source of frames.
struct skill_site {
  explicit skill_site(actor_skill_factory make)
      : setup(setup_in(folder.path())) {
    setup.skills = {{descriptor_of("source"), source},
                    {descriptor_of("work"), std::move(make)}};
    node = std::make_unique<embedded_node>(setup);
    program = std::make_unique<asker>(*node);
  }

  json deploy() {
    return program->ask(task_of(
        {step("work", "work", actor_end("/go"), actor_end("/done")),
         step("source", "source", actor_end("/done"), actor_end("/go"))}));
  }

  json row_of(const std::string& id) {
    const auto all = program->ask({{"type", "instance_query"}});
    for (const auto& x : all.at("instances"))
      if (x.at("spec").at("step") == id)
        return x;
    return nullptr;
  }

  temp_folder folder;
  node_setup setup;
  std::unique_ptr<embedded_node> node;
  std::unique_ptr<asker> program;
};

} // namespace

TEST_CASE("an operation that is registered is placed, run and ended like any "
          "other") {
  std::promise<std::string> seen;
  std::atomic<bool> reported{false};
  std::promise<void> held;
  skill_site site{[&](pointer, const context_type& context) -> behavior {
    context.log("begins");
    context.ready();
    return {
        [&](const skill_frame& x) {
          if (!reported.exchange(true))
            seen.set_value(x.data->payload);
        },
        [](check_life) {},
        [&, context](stop_skill) {
          context.log("holds");
          held.set_value();
        },
    };
  }};
  const auto reply = site.deploy();
  INFO(reply.dump(2));
  REQUIRE(reply.at("type") == "task_accepted");
  auto frame = seen.get_future();
  REQUIRE(frame.wait_for(std::chrono::seconds{30})
          == std::future_status::ready);
  CHECK(frame.get() == "go");
  const auto row = site.row_of("work");
  CHECK(row.at("state") == "running");
  const auto log = site.program->ask(
      {{"type", "log_query"}, {"instance", row.at("spec").at("instance")}});
  CHECK(log.at("text") == "begins\n");
  CHECK(site.program->ask({{"type", "task_termination"}, {"task", "t"}})
            .at("type")
        == "task_terminated");
  auto safe = held.get_future();
  CHECK(safe.wait_for(std::chrono::seconds{0}) == std::future_status::ready);
  CHECK(site.row_of("work") == nullptr);
}

TEST_CASE("an instance that is being ended politely can be ended by force") {
  std::promise<void> asked;
  skill_site site{[&](pointer, const context_type& context) -> behavior {
    context.ready();
    return {
        [](const skill_frame&) {},
        [](check_life) {},
        [&](stop_skill) -> caf::result<void> {
          asked.set_value();
          // It parks for longer than it is given.
          return caf::delegated<void>{};
        },
    };
  }};
  REQUIRE(site.deploy().at("type") == "task_accepted");
  auto polite = std::async(std::launch::async, [&] {
    return asker{*site.node}.ask({{"type", "task_termination"}, {"task", "t"}});
  });
  REQUIRE(asked.get_future().wait_for(std::chrono::seconds{30})
          == std::future_status::ready);
  const auto since = std::chrono::steady_clock::now();
  const auto reply = site.program->ask(
      {{"type", "task_termination"}, {"task", "t"}, {"force", true}});
  CHECK(reply.at("type") == "task_terminated");
  // Politely it has five seconds.
  CHECK(std::chrono::steady_clock::now() - since < std::chrono::seconds{4});
  CHECK(polite.get() == reply);
}

TEST_CASE("an instance says whether it may be ended") {
  skill_site site{[](pointer, const context_type& context) -> behavior {
    context.set_safe(true);
    context.set_safe(false);
    context.ready();
    return {
        [](const skill_frame&) {},
        [](check_life) {},
        [](stop_skill) {},
    };
  }};
  REQUIRE(site.deploy().at("type") == "task_accepted");
  CHECK(site.row_of("work").at("safe") == "unsafe");
}

TEST_CASE("what an instance throws ends that instance alone, with the text in "
          "its log") {
  skill_site site{[](pointer, const context_type& context) -> behavior {
    context.ready();
    return {
        [](const skill_frame&) { throw std::runtime_error{"no grip"}; },
        [](check_life) {},
        [](stop_skill) {},
    };
  }};
  REQUIRE(site.deploy().at("type") == "task_accepted");
  // The log is asked until it has the last word.
  const auto instance = site.row_of("work").at("spec").at("instance");
  std::string text;
  for (int64_t offset = 0; text.find("no grip") == std::string::npos;) {
    const auto part = site.program->ask({{"type", "log_query"},
                                         {"instance", instance},
                                         {"offset", offset},
                                         {"wait_ms", 10'000}});
    REQUIRE(part.contains("text"));
    text += part.at("text").get<std::string>();
    offset = part.at("next_offset");
    REQUIRE((text.find("no grip") != std::string::npos || !part.at("ended")));
  }
  CHECK(text == "it has thrown: no grip\n");
  CHECK_FALSE(site.node->has_ended());
}

TEST_CASE("a factory that throws fails the task with what it has thrown") {
  skill_site site{[](pointer, const context_type&) -> behavior {
    throw std::runtime_error{"the gripper is missing"};
  }};
  const auto reply = site.deploy();
  INFO(reply.dump(2));
  CHECK(reply.at("type") == "error");
  CHECK(reply.at("error")
            .at("log_tail")
            .get<std::string>()
            .find("the gripper is missing")
        != std::string::npos);
  CHECK_FALSE(site.node->has_ended());
}

// By hand, for it takes 40 s: test_embedding "[blocks]".
TEST_CASE("a factory that blocks holds up neither node nor program, and is "
          "told of",
          "[.][blocks]") {
  std::promise<void> never;
  auto blocked = never.get_future().share();
  skill_site site{[blocked](pointer, const context_type&) -> behavior {
    blocked.wait();
    return {
        [](const skill_frame&) {},
        [](check_life) {},
        [](stop_skill) {},
    };
  }};
  const auto reply = site.deploy();
  WARN(reply.dump(2));
  CHECK(reply.at("type") == "error");
  CHECK(reply.dump().find("it stays in its program until it does")
        != std::string::npos);
  CHECK(site.program->ask({{"type", "node_query"}}).contains("identity"));
  never.set_value();
}

TEST_CASE("a folder cannot offer the engine for actors") {
  temp_folder folder;
  auto setup = setup_in(folder.path());
  setup.node.skill_dirs = {folder.path() / "skills"};
  std::filesystem::create_directories(folder.path() / "skills/work");
  std::ofstream{folder.path() / "skills/work/skill.json"}
      << descriptor_of("work");
  embedded_node node{setup};
  const auto shown = asker{node}.ask({{"type", "skill_query"}});
  CHECK(shown.dump().find("the program that embeds a node registers it")
        != std::string::npos);
}
