#include "actors/requests/handler_pipeline.hpp"
#include "test/fixture.hpp"

namespace roscell::test {

namespace {

/// What the handlers below pass on.
struct first_output {
  std::string text;
};

struct second_output {
  std::string text;
};

struct handler_fixture {
  virtual_time time;
  std::vector<record_event> events;
  caf::actor event_collector;
  std::shared_ptr<node_services> services = std::make_shared<node_services>();
  request_history::ticket ticket = 0;

  handler_fixture() {
    event_collector = time.system.spawn([this]() -> caf::behavior {
      return {[this](const record_event& x) { events.push_back(x); }};
    });
    services->context = time.context;
    services->context.events =
        caf::actor_cast<event_log_actor>(event_collector);
  }

  ~handler_fixture() {
    time.kill(event_collector);
  }

  handler_pipeline_actor start(const request_registry& registry,
                               const json& document) {
    return spawn(time.system, services->context, handler_pipeline,
                 *registry.find(document.at("type").get<std::string>()),
                 std::shared_ptr<const node_services>(services),
                 std::make_shared<const json>(document), ticket);
  }

  /// Runs `task_query` for a task through the registry's chain.
  caf::expected<request_processed> run(const request_registry& registry,
                                       const std::string& task) {
    const json request{{"type", "task_query"}, {"task", task}};
    auto reply = time.ask<request_processed>(start(registry, request),
                                             process_request{});
    time.settle();
    REQUIRE(*reply);
    return **reply;
  }
};

void first(const request_context&, task_query query,
           outcome<first_output> done) {
  if (query.task == "stop at once")
    return done.fail(failure{error_code::conflict, "stopped", "/task"});
  if (query.task == "known")
    return done.conclude({{"type", "task_description"}, {"early", true}});
  done.deliver({query.task + ">first"});
}

void second(const request_context&, first_output x,
            outcome<second_output> done) {
  if (x.text == "stop later>first")
    return done.fail(failure{error_code::timeout, "too late"});
  done.deliver({x.text + ">second"});
}

void third(const request_context&, second_output x,
           outcome<task_description> done) {
  task_row row;
  row.task = x.text + ">third";
  done.deliver({{row}});
}

request_registry chain() {
  request_registry result;
  result.add(
      start_with("first", first).then("second", second).then("third", third));
  return result;
}

} // namespace

TEST_CASE_METHOD(handler_fixture,
                 "Each handler's output is the next one's input",
                 "[handler_pipeline]") {
  const auto reply = run(chain(), "t");
  REQUIRE(reply);
  const auto document = json::parse(reply->text);
  CHECK(document.at("type") == "task_description");
  CHECK(document.at("tasks")[0].at("task") == "t>first>second>third");
  CHECK(events.empty());
}

TEST_CASE_METHOD(handler_fixture,
                 "A refusal ends the chain and is told with its handler",
                 "[handler_pipeline]") {
  const auto reply = run(chain(), "stop later");
  REQUIRE_FALSE(reply);
  CHECK(to_failure(reply.error()).code == error_code::timeout);
  REQUIRE(events.size() == 1);
  CHECK(events[0].what == "request_refused");
  CHECK(events[0].subject == "task_query");
  CHECK(json::parse(events[0].data).at("handler") == "second");
  CHECK(to_failure(run(chain(), "stop at once").error()).where == "/task");
}

TEST_CASE_METHOD(handler_fixture,
                 "Each handler is a hop of the request's trace",
                 "[handler_pipeline]") {
  ticket = services->history->begin("task_query", "t", 0,
                                    request_history::time_point{});
  REQUIRE(run(chain(), "t"));
  const auto traces =
      services->history->traces("t", [](uint64_t) { return ""; });
  REQUIRE(traces.size() == 1);
  std::string hops;
  for (const auto& x : traces[0].hops)
    hops += x.handler + " ";
  CHECK(hops == "first second third ");
}

TEST_CASE_METHOD(handler_fixture,
                 "An early reply goes out without the rest of the chain",
                 "[handler_pipeline]") {
  const auto reply = run(chain(), "known");
  REQUIRE(reply);
  CHECK(json::parse(reply->text).at("early") == true);
}

TEST_CASE_METHOD(handler_fixture, "A pipeline ends with its request",
                 "[handler_pipeline]") {
  const auto registry = chain();
  const auto alive = [this] { return time.context.directory->rows().size(); };
  run(registry, "t");
  run(registry, "stop at once");
  run(registry, "known");
  CHECK(alive() == 0);
}

TEST_CASE_METHOD(handler_fixture,
                 "A document that its struct cannot hold is refused",
                 "[handler_pipeline]") {
  auto worker = start(chain(), {{"type", "task_query"}, {"task", 5}});
  auto reply = time.ask<request_processed>(worker, process_request{});
  time.settle();
  REQUIRE(*reply);
  REQUIRE_FALSE(**reply);
  CHECK(to_failure((*reply)->error()).code == error_code::schema_violation);
}

TEST_CASE_METHOD(handler_fixture,
                 "A pipeline that waits tells at which handler",
                 "[handler_pipeline]") {
  request_registry registry;
  registry.add(pipeline<task_query, second_output>{
      [](const request_context& context, const task_query&,
         const outcome<second_output>& done) {
        context.self->state.handler = "before";
        done.deliver({});
      }}
                   .then(
                       "wait", +[](const request_context&, second_output,
                                   outcome<task_description>) {}));
  const auto worker = start(registry, {{"type", "task_query"}});
  auto reply = time.ask<request_processed>(worker, process_request{});
  auto state = time.ask<actor_state>(worker, state_query{});
  time.settle();
  CHECK_FALSE(*reply);
  const auto reported = json::parse((*state)->value().json_text);
  CHECK(reported.at("request") == "task_query");
  CHECK(reported.at("handler") == "wait");
  time.kill(worker);
}

TEST_CASE_METHOD(handler_fixture, "A type without a chain is not found",
                 "[handler_pipeline]") {
  CHECK(chain().find("task_request") == nullptr);
  CHECK(request_registry{}.find("") == nullptr);
}

} // namespace roscell::test
