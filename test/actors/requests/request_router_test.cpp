#include "actors/requests/limits.hpp"
#include "actors/requests/request_router.hpp"
#include "test/actors/fakes/coordinator_fakes.hpp"

#include <functional>
#include <stdexcept>

namespace roscell::test {

namespace {

/// A router with a registry of the test's own.
struct router_fixture {
  virtual_time time;
  request_registry registry;
  request_router_actor router;
  size_t runs = 0;
  caf::actor worker; ///< The pipeline that came last.
  caf::actor gate;   ///< Where requests wait for the test's word.
  std::vector<caf::response_promise> held;
  std::function<void()> word;
  /// The one type that is taken, from coordinators, whose members may be newer.
  std::string only;
  std::shared_ptr<request_history> history;
  std::shared_ptr<metric_table> metrics = std::make_shared<metric_table>();

  router_fixture() {
    gate = time.system.spawn([this](caf::event_based_actor* self) {
      return caf::behavior{
          [this, self](caf::get_atom) {
            held.push_back(self->make_response_promise());
          },
          [this](caf::tick_atom) { word(); },
      };
    });
  }

  ~router_fixture() {
    held.clear();
    worker = nullptr;
    if (router)
      time.kill(router);
    time.kill(gate);
  }

  /// `cell_list_query` is answered at once with the number of the run.
  void answer_at_once() {
    add([this](const request_context&, const outcome<cell_list>& done) {
      cell_list reply;
      reply.cells.resize(1);
      reply.cells[0].size = static_cast<int64_t>(runs);
      done.deliver(reply);
    });
  }

  /// ... or when the test says so.
  void hold() {
    add([this](const request_context& context, const outcome<cell_list>& done) {
      context.self->request(gate, caf::infinite, caf::get_atom_v)
          .then([done](caf::ok_atom) { done.deliver({}); },
                [done](const caf::error& why) { done.fail(why); });
    });
  }

  void let_go(size_t i) {
    say([this, i] { held.at(i).deliver(caf::ok_atom_v); });
  }

  void let_fail(size_t i, error_code code) {
    say([this, i, code] { held.at(i).deliver(fail(code, "held up")); });
  }

  void say(std::function<void()> what) {
    word = std::move(what);
    caf::anon_send(gate, caf::tick_atom_v);
    time.settle();
  }

  using work =
      std::function<void(const request_context&, const outcome<cell_list>&)>;

  void add(const work& job) {
    registry.add(pipeline<cell_list_query, cell_list>{
        [this, job](const request_context& context, const cell_list_query&,
                    const outcome<cell_list>& done) {
          ++runs;
          worker = caf::actor_cast<caf::actor>(context.self);
          job(context, done);
        }});
  }

  /// With a membership this is the router of a member, "arm".
  void start(const membership_actor& membership = {},
             const cell_coordinator_actor& coordinator = {}) {
    auto services = std::make_shared<node_services>();
    history = services->history;
    services->context = time.context;
    services->context.metrics = metrics;
    services->name = "arm";
    services->membership = membership;
    services->coordinator = coordinator;
    router = spawn(time.system, time.context, request_router,
                   std::make_shared<const request_registry>(registry),
                   std::shared_ptr<const node_services>(services));
  }

  pending_reply post(const std::string& text) {
    auto reply = time.ask<request_routed>(router, route_request{text, only});
    time.settle();
    return reply;
  }

  json ask(const std::string& text) {
    return reply_of(post(text));
  }

  json state() {
    auto reply = time.ask<actor_state>(router, state_query{});
    time.settle();
    return json::parse((*reply)->value().json_text);
  }
};

std::string list_query(const std::string& id, const std::string& extra = "") {
  return R"({"type":"cell_list_query","request_id":")" + id + "\"" + extra
         + "}";
}

int64_t run_of(const json& reply) {
  return reply.at("cells").at(0).at("size").get<int64_t>();
}

void list_by_handler(const request_context&, cell_list_query,
                     outcome<cell_list> done) {
  done.deliver({{{"by handler", "", "", "", 0}}});
}

void fail_by_exception(const request_context&, cell_query,
                       outcome<cell_description>) {
  throw std::runtime_error("a defect");
}

void refuse(const request_context&, task_query,
            outcome<task_description> done) {
  done.fail(failure{error_code::unknown_task, "no such task", "/task"});
}

void refuse_for_want_of_room(const request_context&, task_request,
                             outcome<task_accepted> done) {
  done.fail(
      failure{error_code::no_feasible_allocation, "no room", "/pipeline"});
}

std::string task_text(const std::string& task) {
  return json{
      {"type", "task_request"},
      {"task", task},
      {"pipeline", {{{"id", "a"}, {"operation", "echo"}, {"model", "plain"}}}}}
      .dump();
}

} // namespace

TEST_CASE_METHOD(router_fixture,
                 "The way of a command is kept until its end, not a query's",
                 "[router]") {
  registry.add(list_by_handler);
  registry.add(refuse_for_want_of_room);
  start();
  ask(list_query("a"));
  CHECK(error_of(ask(task_text("t"))) == "no_feasible_allocation");
  const auto traces = history->traces("", [](uint64_t) { return ""; });
  REQUIRE(traces.size() == 1);
  CHECK(traces[0].request == "task_request");
  CHECK(traces[0].subject == "t");
  CHECK(traces[0].refusal == "no_feasible_allocation");
  CHECK(traces[0].span_us >= 0);
}

TEST_CASE_METHOD(router_fixture, "A request that is over leaves nothing behind",
                 "[router]") {
  answer_at_once();
  registry.add(refuse);
  start();
  ask(R"({"type":"cell_list_query"})");
  CHECK(error_of(ask(R"({"type":"task_query"})")) == "unknown_task");
  CHECK(time.scheduler.clock().schedule().empty());
  const auto pipeline = worker.address();
  worker = nullptr;
  CHECK(caf::actor_cast<caf::actor_control_block*>(pipeline)->weak_refs == 1);
}

TEST_CASE_METHOD(router_fixture,
                 "A task for which there is no room has been decided about",
                 "[router]") {
  registry.add(refuse_for_want_of_room);
  start();
  const auto reply = ask(task_text("t"));
  const auto kept = history->placement("t");
  REQUIRE(kept);
  CHECK(json::parse(kept->refusal) == reply);
  CHECK(kept->plan.empty());
}

TEST_CASE_METHOD(router_fixture,
                 "A pipeline of the start type goes before a dedicated handler",
                 "[router]") {
  registry.add(list_by_handler);
  answer_at_once();
  start();
  CHECK(run_of(ask(list_query("a"))) == 1);
}

TEST_CASE_METHOD(router_fixture,
                 "A dedicated handler answers what no pipeline takes",
                 "[router]") {
  registry.add(list_by_handler);
  start();
  CHECK(ask(list_query("a")).at("cells")[0].at("cell") == "by handler");
}

TEST_CASE_METHOD(router_fixture,
                 "A request that nobody is registered for is an unknown type",
                 "[router]") {
  answer_at_once();
  start();
  const auto known = ask(R"({"type":"task_query"})");
  CHECK(error_of(known) == "unknown_type");
  CHECK(known.at("error").at("where") == "/type");
  CHECK(error_of(ask(R"({"type":"make_coffee"})")) == "unknown_type");
  // A reply is no request, and neither is a session message.
  CHECK(error_of(ask(R"({"type":"cell_list","cells":[]})")) == "unknown_type");
  CHECK(runs == 0);
}

TEST_CASE_METHOD(router_fixture,
                 "What is refused before any work on it is counted, too",
                 "[router][metrics]") {
  answer_at_once();
  registry.add(refuse);
  start();
  ask("{");
  ask(R"({"type":"make_coffee"})");
  ask(R"({"type":"make_tea"})");
  ask(R"({"type":"task_query","task":7})");
  ask(list_query("a"));
  ask(R"({"type":"task_query","request_id":"a"})");
  std::vector<std::string> counted;
  for (const auto& x : metrics->samples(metric::requests))
    counted.push_back(x.labels[0] + " " + x.labels[1] + " "
                      + std::to_string(static_cast<int>(x.sum)));
  CHECK(counted
        == std::vector<std::string>{
            "cell_list_query done 1", "invalid malformed_json 1",
            "invalid schema_violation 1", "invalid unknown_type 2",
            "task_query conflict 1"});
}

TEST_CASE_METHOD(router_fixture,
                 "A member's router passes on what it has no handler for",
                 "[router]") {
  answer_at_once();
  std::vector<std::string> passed_on;
  const auto membership = time.system.spawn([&passed_on](
                                                caf::event_based_actor*)
                                                -> caf::behavior {
    return {[&passed_on](const route_request& x) {
      passed_on.push_back(x.text);
      return request_routed{R"({"type":"task_description","tasks":[]})", ""};
    }};
  });
  start(caf::actor_cast<membership_actor>(membership));
  CHECK(ask(R"({"type":"task_query"})").at("type") == "task_description");
  CHECK(passed_on == std::vector<std::string>{R"({"type":"task_query"})"});
  // What is no request at all is refused here.
  CHECK(error_of(ask(R"({"type":"make_coffee"})")) == "unknown_type");
  // What it has a handler for is its own.
  CHECK(ask(list_query("a")).at("type") == "cell_list");
  CHECK(passed_on.size() == 1);
  time.kill(membership);
}

TEST_CASE_METHOD(router_fixture,
                 "What asks about a node is answered by that node",
                 "[router]") {
  std::vector<relay_request> relayed;
  const auto coordinator = time.system.spawn([&](caf::event_based_actor*)
                                                 -> caf::behavior {
    return {[&](const relay_request& x) -> caf::result<request_routed> {
      relayed.push_back(x);
      if (x.node == "leg")
        return fail(error_code::unreachable, "node 'leg' is away");
      return request_routed{R"({"type":"actor_inspection","actors":[]})", ""};
    }};
  });
  start({}, caf::actor_cast<cell_coordinator_actor>(coordinator));
  const auto text = [](const std::string& node) {
    return R"({"type":"actor_query","actor":"node","node":")" + node
           + R"(","request_id":"a"})";
  };
  CHECK(ask(text("hand")).at("type") == "actor_inspection");
  REQUIRE(relayed.size() == 1);
  CHECK(relayed[0].node == "hand");
  // There it is an ordinary question.
  CHECK(json::parse(relayed[0].text)
        == json({{"type", "actor_query"}, {"actor", "node"}}));
  CHECK(error_of(ask(text("leg"))) == "unreachable");
  // This node would answer itself, if it had a handler in this test.
  CHECK(error_of(ask(text("arm"))) == "unknown_type");
  CHECK(relayed.size() == 2);
  time.kill(coordinator);
}

TEST_CASE_METHOD(router_fixture,
                 "A member asks its coordinator about others, and about all",
                 "[router]") {
  std::vector<std::string> passed_on;
  const auto membership =
      time.system.spawn([&](caf::event_based_actor*) -> caf::behavior {
        return {[&](const route_request& x) {
          passed_on.push_back(x.text);
          return request_routed{R"({"type":"cost_report","nodes":[]})", ""};
        }};
      });
  start(caf::actor_cast<membership_actor>(membership));
  const std::string about_leg = R"({"node":"leg","type":"cost_query"})";
  const std::string about_all = R"({"cell":true,"type":"cost_query"})";
  CHECK(ask(about_leg).at("type") == "cost_report");
  CHECK(ask(about_all).at("type") == "cost_report");
  CHECK(passed_on == std::vector<std::string>{about_leg, about_all});
  time.kill(membership);
}

TEST_CASE_METHOD(router_fixture,
                 "What is no JSON or breaks its schema reaches no handler",
                 "[router]") {
  registry.add(refuse);
  start();
  CHECK(error_of(ask("{")) == "malformed_json");
  CHECK(error_of(ask("")) == "malformed_json");
  CHECK(error_of(ask("\xff\xfe")) == "malformed_json");
  CHECK(error_of(ask("[1,2]")) != "");
  CHECK(error_of(ask("{}")) != "");
  CHECK(error_of(ask(R"({"type":7})")) != "");
  const auto reply = ask(R"({"type":"task_query","task":7})");
  CHECK(error_of(reply) == "schema_violation");
  CHECK(reply.at("error").at("where") == "/task");
  CHECK(state().at("refused") == 7);
}

TEST_CASE_METHOD(router_fixture,
                 "A handler's refusal is the reply, with its code",
                 "[router]") {
  registry.add(refuse);
  start();
  const auto pending = post(R"({"type":"task_query"})");
  CHECK(error_of(reply_of(pending)) == "unknown_task");
  CHECK((*pending)->value().refusal == "unknown_task");
}

TEST_CASE_METHOD(router_fixture,
                 "A killed pipeline fails its request only, and at once",
                 "[router]") {
  hold();
  start();
  const auto first = post(R"({"type":"cell_list_query"})");
  const auto first_worker = worker;
  const auto second = post(R"({"type":"cell_list_query"})");
  REQUIRE(runs == 2);
  time.kill(first_worker);
  REQUIRE(*first);
  CHECK(error_of(reply_of(first)) == "internal");
  CHECK_FALSE(*second);
  let_go(1);
  CHECK(reply_of(second).at("type") == "cell_list");
  const auto third = post(R"({"type":"cell_list_query"})");
  let_go(2);
  CHECK(reply_of(third).at("type") == "cell_list");
}

TEST_CASE_METHOD(router_fixture, "A handler that throws fails its request only",
                 "[router]") {
  registry.add(fail_by_exception);
  answer_at_once();
  start();
  CHECK(error_of(ask(R"({"type":"cell_query"})")) == "internal");
  CHECK(run_of(ask(list_query("a"))) == 1);
}

TEST_CASE_METHOD(router_fixture,
                 "A request that never ends is given up after 15 minutes",
                 "[router]") {
  hold();
  start();
  const auto reply = post(list_query("a"));
  time.scheduler.clock().advance_time(15min - 1s);
  time.settle();
  CHECK_FALSE(*reply);
  time.scheduler.clock().advance_time(1s);
  time.settle();
  CHECK(error_of(reply_of(reply)) == "timeout");
  // Its pipeline has been ended, and the id is free again.
  post(list_query("a"));
  CHECK(runs == 2);
  let_go(1);
}

TEST_CASE_METHOD(router_fixture,
                 "The same request id with the same body gets the first reply",
                 "[router]") {
  answer_at_once();
  start();
  CHECK(run_of(ask(list_query("a"))) == 1);
  CHECK(run_of(ask(list_query("a"))) == 1);
  // The same JSON in other letters is the same body.
  CHECK(run_of(ask("{ \"request_id\":\"a\", \"type\":\"cell_list_query\" }"))
        == 1);
  CHECK(run_of(ask(list_query("b"))) == 2);
  CHECK(run_of(ask(R"({"type":"cell_list_query"})")) == 3);
  CHECK(run_of(ask(R"({"type":"cell_list_query"})")) == 4);
}

TEST_CASE_METHOD(router_fixture,
                 "A repeated request waits for the one that is being worked on",
                 "[router]") {
  hold();
  start();
  const auto first = post(list_query("a"));
  const auto second = post(list_query("a"));
  CHECK(runs == 1);
  CHECK_FALSE(*second);
  let_go(0);
  CHECK(reply_of(first) == reply_of(second));
}

TEST_CASE_METHOD(router_fixture,
                 "Those who wait for a refused request get its refusal",
                 "[router]") {
  hold();
  start();
  const auto first = post(list_query("a"));
  const auto second = post(list_query("a"));
  let_fail(0, error_code::unreachable);
  CHECK(error_of(reply_of(first)) == "unreachable");
  CHECK(error_of(reply_of(second)) == "unreachable");
}

TEST_CASE_METHOD(router_fixture,
                 "A member that nobody knows is refused, but from coordinators",
                 "[router]") {
  answer_at_once();
  start();
  const auto odd = list_query("a", R"(,"extra":1)");
  CHECK(error_of(ask(odd)) == "schema_violation");
  CHECK(runs == 0);
  only = "cell_list_query";
  CHECK(run_of(ask(odd)) == 1);
}

TEST_CASE_METHOD(router_fixture,
                 "A request id with another body is a conflict that harms none",
                 "[router]") {
  hold();
  start();
  only = "cell_list_query";
  const auto first = post(list_query("a"));
  const auto other = ask(list_query("a", R"(,"extra":1)"));
  CHECK(error_of(other) == "conflict");
  CHECK(other.at("error").at("where") == "/request_id");
  let_go(0);
  CHECK(reply_of(first).at("type") == "cell_list");
  CHECK(error_of(ask(list_query("a", R"(,"extra":1)"))) == "conflict");
}

TEST_CASE_METHOD(router_fixture, "A router that ends takes its pipelines along",
                 "[router]") {
  hold();
  start();
  post(list_query("a"));
  bool ended = false;
  worker->attach_functor([&] { ended = true; });
  CHECK_FALSE(ended);
  time.kill(router);
  CHECK(ended);
}

TEST_CASE_METHOD(router_fixture, "A refused request may be tried again",
                 "[router]") {
  hold();
  start();
  post(list_query("a"));
  let_fail(0, error_code::timeout);
  const auto again = post(list_query("a"));
  CHECK(runs == 2);
  let_go(1);
  CHECK(reply_of(again).at("type") == "cell_list");
}

TEST_CASE_METHOD(router_fixture,
                 "Of the answers only the newest 256 are remembered",
                 "[router]") {
  answer_at_once();
  start();
  for (int i = 0; i < 300; ++i)
    ask(list_query("id-" + std::to_string(i)));
  CHECK(state().at("remembered") == limits::request::remembered);
  CHECK(run_of(ask(list_query("id-299"))) == 300);
  CHECK(run_of(ask(list_query("id-0"))) == 301);
}

TEST_CASE_METHOD(router_fixture, "What is remembered takes 4 MiB at most",
                 "[router]") {
  answer_at_once();
  start();
  only = "cell_list_query";
  const std::string filler(500 * 1024, 'x');
  for (int i = 0; i < 40; ++i)
    REQUIRE(run_of(ask(list_query("id-" + std::to_string(i),
                                  R"(,"extra":")" + filler + "\"")))
            == i + 1);
  CHECK(state().at("remembered") == 8);
}

TEST_CASE_METHOD(router_fixture,
                 "A request that is worked on is never forgotten", "[router]") {
  answer_at_once();
  registry.add(pipeline<task_query, task_description>{
      [](const request_context&, const task_query&,
         const outcome<task_description>&) {}});
  start();
  const std::string long_one = R"({"type":"task_query","request_id":"long"})";
  const auto first = post(long_one);
  for (int i = 0; i < 300; ++i)
    ask(list_query("id-" + std::to_string(i)));
  const auto second = post(long_one);
  CHECK_FALSE(*first);
  CHECK_FALSE(*second);
  CHECK(error_of(ask(R"({"type":"task_query","request_id":"long","task":"x"})"))
        == "conflict");
}

} // namespace roscell::test
