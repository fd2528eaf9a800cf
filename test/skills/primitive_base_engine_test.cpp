#include "skills/engine/primitive_base_engine.hpp"

#include "test/skills/support.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <stdexcept>
#include <thread>

using namespace roscell::engine;
using namespace roscell::test;
using Catch::Matchers::Contains;
using Catch::Matchers::EndsWith;
using Catch::Matchers::StartsWith;

namespace {

/// Gives the numbers from 1 to the one in its endpoint, and then ends, or
/// waits for the stop if the protocol is "live".
struct counter : input_handler {
  explicit counter(const stream_context& c) : config(c.config) {
    // nop
  }

  void open() override {
    if (config.endpoint == "closed")
      throw start_error("the counter is closed");
  }

  void run(frame_sink& sink, const stop_event& stop) override {
    if (config.endpoint == "broken")
      throw stream_error("the counter broke");
    for (auto i = 1; i <= std::stoi(config.endpoint); ++i) {
      frame f;
      f.payload = std::to_string(i);
      f.name = "n" + f.payload;
      sink.push(std::move(f), when_full::wait);
    }
    if (config.protocol == "live")
      stop.wait();
  }

  stream config;
};

/// Gives its numbers only once something was kept for them.
struct late_counter : counter {
  late_counter(const stop_event& e, const stream_context& c)
      : counter(c), kept(e) {
    // nop
  }

  void run(frame_sink& sink, const stop_event& stop) override {
    if (!kept.wait_until(stop_event::clock::now() + patience))
      throw stream_error("nothing was kept");
    counter::run(sink, stop);
  }

  const stop_event& kept;
};

/// What happened in a test, in order.
struct journal {
  std::string text;
  std::string said;
  frame last;
};

/// Writes payloads into a journal.
struct recorder : output_handler {
  recorder(journal& j, const stream_context& c) : log(j), config(c.config) {
    // nop
  }

  void open() override {
    log.text += "open ";
  }

  void write(const frame& result) override {
    if (config.endpoint == "full")
      throw stream_error("the recorder is full");
    log.text += result.payload + " ";
    log.last = result;
  }

  void close() override {
    log.text += "close";
  }

  journal& log;
  stream config;
};

/// Emits its input; fails at payloads that the parameter `bad` contains, of the
/// data type `of` if that is said.
struct repeater : executor {
  repeater(journal& j, const environment& env)
      : log(j), bad(env.parameters.text("bad", "")),
        of(env.parameters.text("of", "")),
        excuse(env.parameters.text("excuse", "")),
        times(env.parameters.count("times", 1, 0, 9)),
        port(env.parameters.count("port", 0, 0, 9)) {
    set_main_input(env.parameters.count("main", 0, 0, 9));
    if (bad == "constructor")
      throw std::runtime_error("no model file");
  }

  void process(const frame& input, emitter& output) override {
    if (bad == "useless")
      throw unusable_input("letters, of which nothing is known; send digits");
    if ((bad == "all" || bad.find(input.payload) != std::string::npos)
        && (of.empty() || of == input.data_type))
      throw std::runtime_error("bad frame");
    if (!excuse.empty())
      output.give_nothing(excuse);
    for (std::uint64_t i = 0; i < times; ++i)
      output.emit(input.payload, port);
  }

  void release() override {
    log.text += "release ";
    if (bad == "release")
      throw std::runtime_error("stuck");
  }

  journal& log;
  std::string bad;
  std::string of;
  std::string excuse;
  std::uint64_t times;
  std::size_t port;
};

/// Keeps the first input's frames until one of the second comes.
struct joiner : executor {
  explicit joiner(stop_event& e) : kept(e) {
    // nop
  }

  void process(const frame& input, emitter& output) override {
    if (input.port == 0) {
      waiting = input.payload;
      set_kept();
      kept.set();
    } else if (!waiting.empty()) {
      set_worked_on(0);
      output.emit(waiting);
      waiting.clear();
    }
  }

  void release() override {
    // nop
  }

  stop_event& kept;
  std::string waiting;
};

/// Says that it is not stop-safe, and that it is when it is wanted to be.
struct careful : executor {
  explicit careful(journal& j) : log(j) {
    set_safe(false);
  }

  void process(const frame&, emitter&) override {
    log.text += "process ";
  }

  void on_safety_wanted() override {
    log.text += "wanted ";
    set_safe(true);
    throw std::runtime_error("the gripper is stuck");
  }

  void release() override {
    log.text += "release ";
  }

  journal& log;
};

struct fixture {
  fixture() {
    for (const auto* protocol : {"finite", "live"})
      parts.add_input(protocol, [](const stream_context& c) {
        return std::make_unique<counter>(c);
      });
    parts.add_output("journal", [this](const stream_context& c) {
      return std::make_unique<recorder>(log, c);
    });
    parts.add_executor("repeat", [this](const environment& e) {
      return std::make_unique<repeater>(log, e);
    });
    parts.add_executor("careful", [this](const environment&) {
      return std::make_unique<careful>(log);
    });
    parts.add_executor("join", [this](const environment&) {
      return std::make_unique<joiner>(kept);
    });
    env.model = "repeat";
    env.inputs = {{"finite", "3", "number"}};
    env.outputs = {{"journal", "j", "digits"}};
  }

  exit_code run(const nlohmann::json& options = nlohmann::json::object()) {
    env.parameters = parameters_of(options);
    primitive_base_engine engine{parts, env, [this](const std::string& line) {
                                   log.said += line + "\n";
                                 }};
    auto result = engine.run();
    status = engine.status();
    frames = engine.frame_counts();
    remark = engine.remark();
    return result;
  }

  registry parts;
  environment env;
  stop_event kept;
  journal log;
  std::string status;
  std::string frames;
  std::string remark;
};

} // namespace

TEST_CASE_METHOD(fixture,
                 "an engine moves all frames and ends with its input") {
  CHECK(run() == exit_code::done);
  CHECK(log.text == "open 1 2 3 release close");
  CHECK(log.said.empty());
  CHECK_THAT(status, Contains("frames=3 dropped=0 failed=0 median_us="));
  CHECK_THAT(status, Contains(" times_us="));
}

TEST_CASE_METHOD(fixture,
                 "an engine fills in what an emitted frame leaves open") {
  CHECK(run({{"times", 2}}) == exit_code::done);
  CHECK(log.text == "open 1 1 2 2 3 3 release close");
  CHECK(log.last.data_type == "digits");
  CHECK(log.last.name == "n3.1");
  CHECK(log.last.sequence == 5);
}

TEST_CASE_METHOD(fixture, "an executor may emit nothing") {
  CHECK(run({{"times", 0}}) == exit_code::done);
  CHECK(log.text == "open release close");
}

TEST_CASE_METHOD(fixture, "an engine joins several inputs and outputs") {
  env.inputs = {{"finite", "2", "n"}, {"finite", "2", "n"}};
  env.outputs.push_back({"journal", "k", "digits"});
  CHECK(run({{"port", 1}}) == exit_code::done);
  CHECK_THAT(status, Contains("frames=4 "));
  CHECK_THAT(log.text, Contains("release closeclose"));
}

TEST_CASE_METHOD(fixture,
                 "a frame that fails is said, and the next one follows") {
  CHECK(run({{"bad", "2"}}) == exit_code::done);
  CHECK(log.text == "open 1 3 release close");
  CHECK(log.said == "frame 'n2' failed (1 in a row): bad frame\n");
}

TEST_CASE_METHOD(fixture, "a frame that fails is no work done") {
  CHECK(run({{"bad", "2"}}) == exit_code::done);
  CHECK_THAT(status, Contains("frames=2 dropped=0 failed=1"));
  CHECK_THAT(frames, StartsWith("input:0 3 2 1 0 "));
  CHECK_THAT(frames, EndsWith(";output:0 2"));
}

TEST_CASE_METHOD(fixture, "an input that always fails ends the skill whatever "
                          "the others bring") {
  env.inputs = {{"finite", "200", "image"}, {"finite", "200", "info"}};
  CHECK(run({{"bad", "all"}, {"of", "image"}, {"max_failures", 20}})
        == exit_code::executor_failed);
  CHECK_THAT(log.said,
             Contains("giving up after 20 failures in a row at input '200'"));
}

TEST_CASE_METHOD(fixture,
                 "what a skill can never use is said once, and ends it") {
  CHECK(run({{"bad", "useless"}}) == exit_code::executor_failed);
  CHECK(log.text == "open release close");
  CHECK(log.said
        == "giving up: '3' brings letters, of which nothing is known; send "
           "digits\n");
}

TEST_CASE_METHOD(fixture, "a frame that is kept for another counts when it is "
                          "worked on") {
  parts.add_input("late", [this](const stream_context& c) {
    return std::make_unique<late_counter>(kept, c);
  });
  env.model = "join";
  env.inputs = {{"finite", "3", "image"}, {"late", "3", "info"}};
  CHECK(run() == exit_code::done);
  const auto emitted = std::count(log.text.begin(), log.text.end(), ' ') - 1;
  CAPTURE(log.text);
  CHECK(emitted >= 1);
  CHECK_THAT(frames,
             StartsWith("input:0 3 " + std::to_string(emitted) + " 0 "));
}

TEST_CASE_METHOD(fixture, "failures of several inputs are not added up") {
  env.inputs = {{"finite", "2", "a"}, {"finite", "2", "b"}};
  CHECK(run({{"bad", "12"}, {"max_failures", 3}}) == exit_code::done);
}

TEST_CASE_METHOD(fixture, "a skill's frames are those of its first input and "
                          "of others of that data type") {
  env.inputs = {{"finite", "3", "image"},
                {"finite", "5", "info"},
                {"finite", "2", "image"}};
  CHECK(run() == exit_code::done);
  CHECK_THAT(status, StartsWith("frames=5 "));
  CHECK_THAT(frames, Contains("input:0 3 3 0 0 ")
                         && Contains(";input:1 5 5 0 0 ")
                         && Contains(";input:2 2 2 0 0 "));
}

TEST_CASE_METHOD(fixture, "an executor may say which input it works on") {
  env.inputs = {{"finite", "5", "info"}, {"finite", "3", "image"}};
  CHECK(run({{"main", 1}}) == exit_code::done);
  CHECK_THAT(status, StartsWith("frames=3 "));
}

TEST_CASE_METHOD(fixture, "a skill of whose frames nothing comes says so, with "
                          "its reason") {
  env.inputs[0].endpoint = "12";
  CHECK(run({{"times", 0}, {"excuse", "no CameraInfo has come"}})
        == exit_code::done);
  CHECK(remark == "12 frames in, none out: no CameraInfo has come");
  CHECK(run({{"times", 0}}) == exit_code::done);
  CHECK(remark == "12 frames in, none out");
  CHECK(run() == exit_code::done);
  CHECK(remark.empty());
}

TEST_CASE_METHOD(fixture, "a few frames of which nothing comes say nothing") {
  env.inputs[0].endpoint = "9";
  CHECK(run({{"times", 0}, {"excuse", "too early"}}) == exit_code::done);
  CHECK(remark.empty());
}

TEST_CASE_METHOD(fixture, "a skill without outputs is not blamed for that") {
  env.inputs[0].endpoint = "12";
  env.outputs.clear();
  CHECK(run({{"times", 0}}) == exit_code::done);
  CHECK(remark.empty());
}

TEST_CASE_METHOD(fixture, "a skill all of whose frames fail says why") {
  env.inputs[0].endpoint = "12";
  CHECK(run({{"bad", "all"}, {"max_failures", 99}}) == exit_code::done);
  CHECK(remark == "12 frames in, none out: bad frame");
}

TEST_CASE_METHOD(fixture, "too many failures in a row end the skill") {
  env.inputs[0].endpoint = "9";
  CHECK(run({{"bad", "2 45 789"}, {"max_failures", 3}})
        == exit_code::executor_failed);
  CHECK(log.text == "open 1 3 6 release close");
  CHECK_THAT(log.said, Contains("giving up after 3 failures in a row"));
}

TEST_CASE_METHOD(fixture,
                 "emitting to an output that is not there is a failure") {
  CHECK(run({{"port", 1}}) == exit_code::done);
  CHECK_THAT(log.said, Contains("output 1, but the step has 1 outputs"));
}

TEST_CASE_METHOD(fixture, "an output that breaks ends the skill") {
  env.outputs[0].endpoint = "full";
  CHECK(run() == exit_code::stream_failed);
  CHECK(log.said == "output broke: the recorder is full\n");
  CHECK(log.text == "open release close");
}

TEST_CASE_METHOD(fixture, "an input that breaks ends the skill") {
  env.inputs.push_back({"finite", "broken", "n"});
  env.inputs[0].protocol = "live";
  CHECK(run() == exit_code::stream_failed);
  CHECK_THAT(log.said, Contains("input 1 broke: the counter broke"));
  CHECK_THAT(log.text, Contains("release close"));
}

TEST_CASE_METHOD(fixture, "a release that fails shows in the exit code") {
  CHECK(run({{"bad", "release"}}) == exit_code::executor_failed);
  CHECK_THAT(log.said, Contains("release failed: stuck"));
  CHECK_THAT(log.text, Contains("close"));
}

TEST_CASE_METHOD(fixture, "a part that cannot be made or opened is named") {
  auto said_by = [&](const nlohmann::json& options = nlohmann::json::object()) {
    log.said.clear();
    CHECK(run(options) == exit_code::cannot_start);
    CHECK_THAT(log.said, Contains("cannot start: "));
    return log.said;
  };
  CHECK_THAT(said_by({{"bad", "constructor"}}), Contains("no model file"));
  env.inputs[0].endpoint = "closed";
  CHECK_THAT(said_by(), Contains("the counter is closed"));
  env.inputs[0].protocol = "telepathy";
  CHECK_THAT(said_by(), Contains("no input protocol 'telepathy'")
                            && Contains("file, finite, live"));
  env.outputs[0].protocol = "telepathy";
  CHECK_THAT(said_by(), Contains("no output protocol 'telepathy'")
                            && Contains("file, journal"));
  env.model = "yolo";
  CHECK_THAT(said_by(), Contains("no model 'yolo'") && Contains("repeat"));
}

TEST_CASE_METHOD(fixture, "a step must not feed itself") {
  env.outputs[0] = env.inputs[0];
  CHECK(run() == exit_code::cannot_start);
  CHECK_THAT(log.said, Contains("both an input and an output"));
}

TEST_CASE_METHOD(fixture, "a stop before the start ends the skill cleanly") {
  env.inputs[0].protocol = "live";
  primitive_base_engine engine{parts, env, [](const std::string&) {}};
  engine.request_stop();
  CHECK(engine.run() == exit_code::done);
  CHECK(log.text == "open release close");
}

namespace {

/// A node that hears what the skill tells it.
struct notified_node : fixture {
  temp_folder folder;
  notify_receiver node{folder / "notify"};

  notified_node() {
    env.notify_socket = folder / "notify";
  }
};

} // namespace

TEST_CASE_METHOD(notified_node,
                 "an engine tells its node of its start and its end") {
  CHECK(run() == exit_code::done);
  CHECK(node.receive() == "READY=1");
  CHECK_THAT(node.receive().value_or(""),
             Contains("STOPPING=1\nSTATUS=frames=3 "));
}

TEST_CASE_METHOD(notified_node,
                 "a node is told of the frames of each stream, and in "
                 "one short line why nothing comes of them") {
  env.inputs[0].endpoint = "12";
  CHECK(run({{"times", 0}, {"excuse", "a\nb" + std::string(5000, 'x')}})
        == exit_code::done);
  CHECK(node.receive() == "READY=1");
  const auto last = node.receive().value_or("");
  CHECK_THAT(last, Contains("\nROSCELL_FRAMES=input:0 12 12 0 0 "));
  CHECK_THAT(last, Contains("\nROSCELL_REMARK=12 frames in, none out: a bxxx"));
  CHECK(last.size() < 1000);
}

TEST_CASE_METHOD(notified_node, "a skill that cannot start is never ready") {
  env.inputs[0].endpoint = "closed";
  CHECK(run() == exit_code::cannot_start);
  CHECK_FALSE(node.receive_now());
}

TEST_CASE_METHOD(notified_node,
                 "an executor says whether it is stop-safe, and hears that "
                 "somebody waits for that") {
  env.model = "careful";
  env.inputs[0] = {"live", "0", "n"};
  primitive_base_engine engine{
      parts, env, [this](const std::string& line) { log.said += line + "\n"; }};
  std::thread runner{[&] { CHECK(engine.run() == exit_code::done); }};
  CHECK(node.wait_for("ROSCELL_SAFE=0"));
  engine.want_safety();
  CHECK(node.wait_for("ROSCELL_SAFE=1"));
  engine.request_stop();
  runner.join();
  CHECK(log.text == "open wanted release close");
  CHECK(log.said == "on_safety_wanted failed: the gripper is stuck\n");
}

TEST_CASE_METHOD(fixture, "an executor that does not care goes on when it is "
                          "wanted to be stop-safe") {
  primitive_base_engine engine{parts, env, [](const std::string&) {}};
  engine.want_safety();
  CHECK(engine.run() == exit_code::done);
  CHECK(log.text == "open 1 2 3 release close");
}

TEST_CASE_METHOD(notified_node,
                 "streams are measured where the node wants to know") {
  env.health = true;
  env.inputs = {{"live", "3", "n"}, {"live", "0", "n"}};
  primitive_base_engine engine{parts, env, [](const std::string&) {}};
  std::thread runner{[&] { engine.run(); }};
  const auto reported = node.wait_for("ROSCELL_STREAMS=").value_or("");
  engine.request_stop();
  runner.join();
  CHECK_THAT(reported, Contains("WATCHDOG=1\nROSCELL_STREAMS=input:0 "));
  CHECK_THAT(reported, Contains(";input:1 0.000 -;output:0 "));
  CHECK(reported.find("output:0 0.000 -") == std::string::npos);
}
