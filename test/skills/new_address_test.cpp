#include "skills/engine/primitive_base_engine.hpp"

#include "test/skills/support.hpp"

#include <catch2/catch.hpp>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <thread>

using namespace roscell::engine;
using namespace roscell::test;
using Catch::Matchers::Contains;
using Catch::Matchers::StartsWith;

namespace {

/// What has happened to a skill whose host gets another address. Lines come
/// from the executor's thread alone.
struct address_journal {
  std::string text;
  std::string said;
  stop_event written;
  stop_event resumed;
  stop_event written_again;
  stop_event ended;

  static bool await(const stop_event& x) {
    return x.wait_until(steady::now() + patience);
  }
};

/// Gives one frame, and another one when it has been resumed.
struct resuming_input : input_handler {
  explicit resuming_input(address_journal& j) : log(j) {
    // nop
  }

  void open() override {
    // nop
  }

  void run(frame_sink& sink, const stop_event& stop) override {
    frame f;
    f.payload = "1";
    sink.push(f, when_full::wait);
    if (!stop.wait_readable(log.resumed.fd()))
      return;
    f.payload = "2";
    sink.push(f, when_full::wait);
    stop.wait();
  }

  bool survives_new_address() const override {
    return true;
  }

  void suspend() override {
    log.text += "suspend_input ";
  }

  void resume(const changed_variables&) override {
    log.text += "resume_input ";
    log.resumed.set();
  }

  address_journal& log;
};

/// Stays where it is.
struct staying_input : input_handler {
  void open() override {
    // nop
  }

  void run(frame_sink&, const stop_event& stop) override {
    stop.wait();
  }
};

struct staying_output : output_handler {
  explicit staying_output(address_journal& j) : log(j) {
    // nop
  }

  void open() override {
    log.text += "open ";
  }

  void write(const frame& result) override {
    log.text += result.payload + " ";
    (result.payload == "1" ? log.written : log.written_again).set();
  }

  void close() override {
    log.text += "close";
  }

  address_journal& log;
};

struct resuming_output : staying_output {
  using staying_output::staying_output;

  bool survives_new_address() const override {
    return true;
  }

  void suspend() override {
    log.text += "suspend_output ";
  }

  void resume(const changed_variables& reported) override {
    if (reported.at("AT") == "nowhere")
      throw start_error("there is no way to nowhere");
    log.text += "resume_output_" + reported.at("AT") + " ";
  }
};

struct passing_on : executor {
  explicit passing_on(address_journal& j) : log(j) {
    // nop
  }

  void process(const frame& input, emitter& output) override {
    output.emit(input.payload);
  }

  void on_safety_wanted() override {
    log.text += "wanted ";
  }

  void release() override {
    log.text += "release ";
  }

  address_journal& log;
};

/// Has a connection of its own.
struct connected : passing_on {
  explicit connected(address_journal& j) : passing_on(j) {
    set_bound_to_address();
  }
};

/// A skill whose node can tell it where the cell is.
struct address_fixture {
  address_fixture() : node(folder / "notify") {
    parts.add_input("moves", [this](const stream_context&) {
      return std::make_unique<resuming_input>(log);
    });
    parts.add_input("stays", [](const stream_context&) {
      return std::make_unique<staying_input>();
    });
    parts.add_output("moves", [this](const stream_context&) {
      return std::make_unique<resuming_output>(log);
    });
    parts.add_output("stays", [this](const stream_context&) {
      return std::make_unique<staying_output>(log);
    });
    parts.add_executor("plain", [this](const environment&) {
      return std::make_unique<passing_on>(log);
    });
    parts.add_executor("connected", [this](const environment&) {
      return std::make_unique<connected>(log);
    });
    env.model = "plain";
    env.inputs = {{"moves", "in", "number"}};
    env.outputs = {{"moves", "out", "number"}};
    env.notify_socket = folder / "notify";
    CHECK(::mkfifo((folder / "notify.environment").c_str(), 0600) == 0);
  }

  unique_fd way_to_skill() const {
    return unique_fd{::open((folder / "notify.environment").c_str(),
                            O_WRONLY | O_NONBLOCK | O_CLOEXEC)};
  }

  void write_line(const std::string& text) const {
    const auto fifo = way_to_skill();
    CHECK(::write(fifo.get(), text.data(), text.size())
          == static_cast<ssize_t>(text.size()));
  }

  bool has_listener() const {
    return static_cast<bool>(way_to_skill());
  }

  /// `use` is called once the skill is ready.
  template <class F>
  exit_code run_until(F use) {
    primitive_base_engine engine{parts, env, [this](const std::string& line) {
                                   log.said += line + "\n";
                                 }};
    auto result = exit_code::done;
    std::thread runner{[&] {
      result = engine.run();
      log.ended.set();
    }};
    CHECK(node.wait_for("READY=1"));
    use(engine);
    engine.request_stop();
    runner.join();
    return result;
  }

  temp_folder folder;
  notify_receiver node;
  address_journal log;
  registry parts;
  environment env;
};

} // namespace

TEST_CASE_METHOD(address_fixture,
                 "inputs and outputs go on at another address, and the "
                 "executor does not notice") {
  const auto code = run_until([&](auto&) {
    CHECK(has_listener());
    CHECK(log.await(log.written));
    write_line("{\"AT\": \"10.0.0.9\"}\n");
    CHECK(log.await(log.written_again));
    CHECK(has_listener());
  });
  CHECK(code == exit_code::done);
  CHECK(log.text
        == "open 1 suspend_input suspend_output resume_output_10.0.0.9 "
           "resume_input 2 release close");
  CHECK_THAT(log.said, Contains("made anew in "));
  CHECK_FALSE(has_listener());
}

TEST_CASE_METHOD(address_fixture,
                 "what finds no way at another address ends the skill with an "
                 "error") {
  const auto code = run_until([&](auto&) {
    CHECK(log.await(log.written));
    write_line("{\"AT\": ");
    write_line("\"nowhere\"}\n");
    CHECK(log.await(log.ended));
  });
  CHECK(code == exit_code::stream_failed);
  CHECK_THAT(log.said, Contains("cannot go on at another address of this "
                                "host: there is no way to nowhere"));
}

TEST_CASE_METHOD(address_fixture, "what cannot be read moves nothing") {
  run_until([&](auto& engine) {
    CHECK(log.await(log.written));
    for (const auto* text : {"", R"({"AT": )", "[]", "{}", R"({"AT": 1})"})
      write_line(std::string{text} + "\n");
    write_line(std::string(35'000, 'a'));
    engine.use_variables({{"AT", "there"}});
    CHECK(log.await(log.written_again));
  });
  CHECK_THAT(log.text, Contains("resume_output_there resume_input"));
  CHECK(log.text.find("suspend_input") == log.text.rfind("suspend_input"));
}

TEST_CASE_METHOD(address_fixture,
                 "a skill with a part that cannot move hears of no address") {
  SECTION("an output") {
    env.outputs.push_back({"stays", "k", "number"});
  }
  SECTION("an input") {
    env.inputs.push_back({"stays", "k", "number"});
  }
  SECTION("the executor") {
    env.model = "connected";
  }
  run_until([&](auto&) { CHECK_FALSE(has_listener()); });
}

TEST_CASE_METHOD(
    address_fixture,
    "who waits for a skill to be stop-safe is not overtaken by a move") {
  primitive_base_engine engine{parts, env, [](const std::string&) {}};
  engine.want_safety();
  engine.use_variables({{"AT", "here"}});
  engine.use_variables({{"AT", "there"}});
  std::thread runner{[&] { engine.run(); }};
  CHECK(log.await(log.resumed));
  engine.request_stop();
  runner.join();
  CHECK_THAT(log.text, StartsWith("open wanted suspend_input suspend_output "
                                  "resume_output_there resume_input "));
}
