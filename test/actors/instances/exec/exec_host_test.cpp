#include "actors/instances/exec/exec_host.hpp"

#include "actors/edge/exec/limits.hpp"
#include "messages/failure.hpp"
#include "schemas/utf8.hpp"
#include "test/fixture.hpp"

#include <string>
#include <utility>
#include <vector>

using namespace roscell;
using namespace roscell::test;
using namespace std::chrono_literals;

namespace {

/// A command that does what the test says, and notes what it is asked.
struct fake_command : exec_channel {
  void write(std::string bytes, bool last) override {
    given += bytes + (last ? "|" : "");
  }

  void resize(terminal_size size) override {
    columns = size.columns;
  }

  void read_on(bool of_errors) override {
    reads += of_errors ? "e" : "o";
  }

  void end(std::string reason) override {
    ends.push_back(std::move(reason));
  }

  std::string given;
  std::string reads;
  std::vector<std::string> ends;
  int columns = 0;
};

/// The host, with a supervisor that knows one instance.
struct exec_bench : virtual_time {
  exec_bench() {
    row.spec.instance = "i";
    row.state = instance_state::running;
    row.container = "4711:99";
    exec_host_config config;
    config.context = context;
    config.context.events = events();
    config.node = "arm";
    config.supervisor = supervisor();
    config.open = [this](const exec_order& order, exec_callbacks calls)
        -> edge_result<std::shared_ptr<exec_channel>> {
      orders.push_back(order);
      if (!refusal.empty())
        return edge_error{error_code::engine_failed, refusal, ""};
      callbacks = std::move(calls);
      command = std::make_shared<fake_command>();
      return std::shared_ptr<exec_channel>{command};
    };
    host = spawn(system, config.context, exec_host, config);
    settle();
  }

  ~exec_bench() {
    kill(host);
  }

  event_log_actor events() {
    auto* kept = &published;
    return caf::actor_cast<event_log_actor>(
        system.spawn([kept]() -> caf::behavior {
          return {[kept](const record_event& x) { kept->push_back(x); }};
        }));
  }

  container_supervisor_actor supervisor() {
    auto* known = &row;
    return caf::actor_cast<container_supervisor_actor>(
        system.spawn([known]() -> caf::behavior {
          return {[known](const instance_query& x)
                      -> caf::result<instance_description> {
            if (x.instance != known->spec.instance)
              return fail(error_code::unknown_task, "there is no instance");
            return instance_description{{*known}};
          }};
        }));
  }

  auto begin(exec_request what) {
    if (what.command.empty())
      what.command = {"/bin/cat", "secret"};
    auto result = ask<exec_started>(host, what);
    settle();
    return result;
  }

  static exec_request on(const std::string& instance) {
    exec_request result;
    result.instance = instance;
    result.from = "root";
    return result;
  }

  /// A command that runs; its session.
  std::string run() {
    auto answer = begin(on("i"));
    callbacks.on_started();
    settle();
    return answer->value()->session;
  }

  auto input(const std::string& session, int64_t offset,
             const std::string& bytes, bool ended = false) {
    exec_input x;
    x.session = session;
    x.offset = offset;
    x.bytes = to_base64(bytes);
    x.ended = ended;
    auto result = ask<exec_input_taken>(host, x);
    settle();
    return result;
  }

  auto output(const std::string& session, int64_t offset,
              int64_t wait_ms = 5000) {
    exec_output_query x;
    x.session = session;
    x.offset = offset;
    x.wait_ms = wait_ms;
    auto result = ask<exec_output>(host, x);
    settle();
    return result;
  }

  template <class Answer>
  static failure why(const Answer& answer) {
    REQUIRE(answer->has_value());
    REQUIRE_FALSE(**answer);
    return to_failure((*answer)->error());
  }

  instance_row row;
  std::string refusal;
  std::vector<exec_order> orders;
  exec_callbacks callbacks;
  std::shared_ptr<fake_command> command;
  std::vector<record_event> published;
  exec_host_actor host;
};

} // namespace

TEST_CASE("a command begins beside an instance, and an event says so") {
  exec_bench b;
  auto what = b.on("i");
  what.terminal = true;
  what.columns = 80;
  what.rows = 24;
  const auto answer = b.begin(what);
  CHECK_FALSE(answer->has_value());
  b.callbacks.on_started();
  b.settle();
  REQUIRE(answer->has_value());
  REQUIRE(b.orders.size() == 1);
  CHECK(b.orders[0].container == "4711:99");
  CHECK(b.orders[0].size.columns == 80);
  CHECK(b.orders[0].session == answer->value()->session);
  REQUIRE(b.published.size() == 1);
  CHECK(b.published[0].what == "exec_begun");
  CHECK(b.published[0].subject == "i");
  const auto data = json::parse(b.published[0].data);
  CHECK(data.at("program") == "cat");
  CHECK(data.at("from") == "root");
  CHECK(b.published[0].data.find("secret") == std::string::npos);
}

TEST_CASE("what cannot be run is refused, with the place and a remedy") {
  exec_bench b;
  CHECK(b.why(b.begin(b.on("j"))).code == error_code::unknown_task);
  auto long_one = b.on("i");
  long_one.command = {std::string(limits::exec::command_bytes, 'x')};
  CHECK(b.why(b.begin(long_one)).code == error_code::schema_violation);
  CHECK(b.why(b.begin(long_one)).where == "/command");
  b.row.state = instance_state::failed;
  const auto ended = b.why(b.begin(b.on("i")));
  CHECK(ended.code == error_code::conflict);
  CHECK(ended.message == "instance 'i' does not run now: it is failed");
  b.row.state = instance_state::running;
  b.row.container = "actor:echo";
  CHECK(b.why(b.begin(b.on("i"))).code == error_code::conflict);
  b.row.container = "4711:99";
  b.refusal = "no processes are left";
  CHECK(b.why(b.begin(b.on("i"))).message == "no processes are left");
  b.refusal.clear();
  b.run();
}

TEST_CASE("a command that its engine does not begin is an error") {
  exec_bench b;
  const auto answer = b.begin(b.on("i"));
  b.callbacks.on_end(137, "the engine refuses it");
  b.settle();
  CHECK(b.why(answer).message
        == "the command cannot be run: the engine refuses it");
}

TEST_CASE("one command more than a node takes is refused") {
  exec_bench b;
  for (size_t i = 0; i < limits::exec::most; ++i)
    b.run();
  CHECK(b.why(b.begin(b.on("i"))).code == error_code::conflict);
}

TEST_CASE("output answers whoever waits for it") {
  exec_bench b;
  const auto session = b.run();
  const auto answer = b.output(session, 0);
  CHECK_FALSE(answer->has_value());
  b.callbacks.on_output(true, "hot");
  b.settle();
  REQUIRE(answer->has_value());
  CHECK(answer->value()->bytes == to_base64("hot"));
  CHECK(answer->value()->of_errors);
  CHECK(answer->value()->next_offset == 3);
  CHECK(b.command->reads == "e");
}

TEST_CASE("a question for output that has waited long enough is answered") {
  exec_bench b;
  const auto session = b.run();
  const auto answer = b.output(session, 0);
  b.advance(4900ms);
  CHECK_FALSE(answer->has_value());
  b.advance(100ms);
  REQUIRE(answer->has_value());
  CHECK(answer->value()->bytes.empty());
  CHECK_FALSE(answer->value()->ended);
  CHECK(b.output(session, 0, 0)->has_value());
}

TEST_CASE("a command whose output nobody takes is not read on") {
  exec_bench b;
  const auto session = b.run();
  const std::string part(limits::exec::waiting_bytes / 2, 'x');
  b.callbacks.on_output(false, part);
  b.settle();
  CHECK(b.command->reads == "o");
  b.callbacks.on_output(false, part);
  b.settle();
  CHECK(b.command->reads == "o");
  const auto first = b.output(session, 0);
  b.output(session, first->value()->next_offset);
  CHECK(b.command->reads == "oo");
}

TEST_CASE("input waits until the command has taken what came before") {
  exec_bench b;
  const auto session = b.run();
  CHECK(b.input(session, 0, "one")->value()->next_offset == 3);
  const auto second = b.input(session, 3, "two");
  CHECK_FALSE(second->has_value());
  CHECK(b.command->given == "one");
  b.callbacks.on_input_taken();
  b.settle();
  CHECK(second->value()->next_offset == 6);
  CHECK(b.command->given == "onetwo");
  const auto third = b.input(session, 6, "three");
  b.advance(limits::exec::wait);
  CHECK(third->value()->next_offset == 6);
  CHECK(b.input(session, 0, "one")->value()->next_offset == 6);
  CHECK(b.why(b.input(session, 9, "late")).code == error_code::conflict);
}

TEST_CASE("the end of input comes after what was given before") {
  exec_bench b;
  const auto session = b.run();
  b.input(session, 0, "one");
  CHECK(b.input(session, 3, "", true)->value()->next_offset == 3);
  CHECK(b.command->given == "one");
  b.callbacks.on_input_taken();
  b.settle();
  CHECK(b.command->given == "one|");
}

TEST_CASE("a command ends with its last output and its exit code") {
  exec_bench b;
  const auto session = b.run();
  b.callbacks.on_output(false, "last");
  b.callbacks.on_end(3, "");
  b.settle();
  const auto answer = b.output(session, 0);
  REQUIRE(answer->has_value());
  CHECK(answer->value()->ended);
  CHECK(answer->value()->exit_code == 3);
  CHECK(answer->value()->bytes == to_base64("last"));
  CHECK(b.why(b.output(session, 4)).code == error_code::unknown_task);
  REQUIRE(b.published.size() == 2);
  CHECK(b.published[1].what == "exec_ended");
  CHECK(json::parse(b.published[1].data).at("exit_code") == 3);
}

TEST_CASE("a command whose operator is gone is ended and forgotten") {
  exec_bench b;
  const auto session = b.run();
  b.output(session, 0);
  b.advance(limits::exec::lease - 100ms);
  CHECK(b.command->ends.empty());
  b.advance(100ms);
  REQUIRE(b.command->ends.size() == 1);
  CHECK(b.command->ends[0] == "nobody has asked for its output for 15 s");
  b.callbacks.on_end(137, b.command->ends[0]);
  b.advance(limits::exec::lease);
  CHECK(b.why(b.output(session, 0)).code == error_code::unknown_task);
}

TEST_CASE("an operator whose reader is slow keeps his command") {
  exec_bench b;
  const auto session = b.run();
  for (int i = 0; i < 10; ++i) {
    b.advance(4s);
    CHECK(b.input(session, 0, "")->value()->next_offset == 0);
  }
  CHECK(b.command->ends.empty());
}

TEST_CASE("whoever hangs up ends his command") {
  exec_bench b;
  exec_input x;
  x.session = b.run();
  x.hang_up = true;
  b.ask<exec_input_taken>(b.host, x);
  b.settle();
  CHECK(b.command->ends.size() == 1);
}

TEST_CASE("a terminal's size is passed on") {
  exec_bench b;
  exec_input x;
  x.session = b.run();
  x.columns = 132;
  x.rows = 43;
  b.ask<exec_input_taken>(b.host, x);
  b.settle();
  CHECK(b.command->columns == 132);
}

TEST_CASE("a node without commands has no timer for them") {
  exec_bench b;
  CHECK(b.pass(1h) == 0);
  const auto session = b.run();
  b.callbacks.on_end(0, "");
  b.settle();
  b.output(session, 0);
  b.pass(limits::exec::lease);
  CHECK(b.pass(1h) == 0);
}
