#include "skills/engine/primitive_base_engine.hpp"

#include "test/skills/support.hpp"

#include <catch2/catch.hpp>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <condition_variable>
#include <mutex>
#include <thread>

using namespace roscell::engine;
using namespace roscell::test;
using Catch::Matchers::Contains;
using Catch::Matchers::EndsWith;

namespace {

/// Gives "1", and "2" when it is told to.
struct prompted_input : input_handler {
  explicit prompted_input(const stop_event& e) : prompt(e) {
    // nop
  }

  void open() override {
    // nop
  }

  void run(frame_sink& sink, const stop_event& stop) override {
    frame f;
    f.payload = "1";
    sink.push(f, when_full::wait);
    if (!stop.wait_readable(prompt.fd()))
      return;
    f.payload = "2";
    sink.push(f, when_full::wait);
    stop.wait();
  }

  const stop_event& prompt;
};

/// What has come out, by the executor's thread alone.
struct results {
  std::string text;
  stop_event first;
  stop_event second;
};

struct result_output : output_handler {
  explicit result_output(results& r) : log(r) {
    // nop
  }

  void open() override {
    // nop
  }

  void write(const frame& result) override {
    log.text += result.payload + " ";
    (log.text.size() > 3 ? log.second : log.first).set();
  }

  void close() override {
    // nop
  }

  results& log;
};

/// Puts a word before its frames, which has at most three letters.
struct prefixer : executor {
  explicit prefixer(const environment& env)
      : word(env.parameters.text("word", "")) {
    // nop
  }

  void process(const frame& input, emitter& output) override {
    output.emit(word + input.payload);
  }

  void on_parameters(const parameters& now) override {
    auto wanted = now.text("word", "");
    if (wanted.size() > 3)
      throw start_error("a word of at most\nthree letters is needed");
    word = wanted;
  }

  void release() override {
    // nop
  }

  std::string word;
};

/// What a view was told, by any thread.
class logged_answers {
public:
  void add(const std::string& text) {
    const std::lock_guard guard{mutex_};
    all_.push_back(text);
    changed_.notify_all();
  }

  bool wait_for(const std::string& text) {
    std::unique_lock guard{mutex_};
    return changed_.wait_for(guard, patience, [&] {
      return std::find(all_.begin(), all_.end(), text) != all_.end();
    });
  }

  std::vector<std::string> all() const {
    const std::lock_guard guard{mutex_};
    return all_;
  }

private:
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<std::string> all_;
};

/// Takes none.
struct fixed : executor {
  void process(const frame& input, emitter& output) override {
    output.emit(input.payload + "-");
  }

  void release() override {
    // nop
  }
};

struct tuned_skill {
  tuned_skill() : node(folder / "notify") {
    parts.add_input("prompted", [this](const stream_context&) {
      return std::make_unique<prompted_input>(prompt);
    });
    parts.add_output("kept", [this](const stream_context&) {
      return std::make_unique<result_output>(log);
    });
    parts.add_executor("prefix", [](const environment& x) {
      return std::make_unique<prefixer>(x);
    });
    parts.add_executor(
        "fixed", [](const environment&) { return std::make_unique<fixed>(); });
    env.model = "prefix";
    env.inputs = {{"prompted", "in", "number"}};
    env.outputs = {{"kept", "out", "number"}};
    env.notify_socket = folder / "notify";
    env.parameters = parameters_of({{"word", "a"}});
    CHECK(::mkfifo(fifo().c_str(), 0600) == 0);
  }

  std::string fifo() const {
    return folder / "notify.parameters";
  }

  void write_line(const std::string& text) const {
    const unique_fd out{
        ::open(fifo().c_str(), O_WRONLY | O_NONBLOCK | O_CLOEXEC)};
    REQUIRE(out);
    CHECK(::write(out.get(), text.data(), text.size())
          == static_cast<ssize_t>(text.size()));
  }

  bool has_come(const stop_event& x) const {
    return x.wait_until(stop_event::clock::now() + patience);
  }

  template <class F>
  void run_until(F use) {
    primitive_base_engine engine{
        parts, env, [this](const std::string& line) { said += line + "\n"; }};
    std::thread runner{[&] { engine.run(); }};
    CHECK(node.wait_for("READY=1"));
    use(engine);
    engine.request_stop();
    runner.join();
  }

  temp_folder folder;
  notify_receiver node;
  stop_event prompt;
  results log;
  registry parts;
  environment env;
  std::string said;
};

} // namespace

TEST_CASE_METHOD(tuned_skill,
                 "other parameters count from the next frame on, and the node "
                 "hears it") {
  run_until([&](auto&) {
    CHECK(has_come(log.first));
    write_line("\n{\"number\":41,\"parameters\":{\"word\":\"b\"}}\n");
    CHECK(node.wait_for("ROSCELL_PARAMETERS_TAKEN=41"));
    prompt.set();
    CHECK(has_come(log.second));
  });
  CHECK(log.text == "a1 b2 ");
  CHECK_THAT(said, Contains(R"(it works with these parameters: {"word":"b"})"));
}

TEST_CASE_METHOD(tuned_skill,
                 "what an executor refuses leaves it as it was, and the node "
                 "hears why") {
  run_until([&](auto&) {
    CHECK(has_come(log.first));
    write_line("{\"number\":42,\"parameters\":{\"word\":\"long\"}}\n");
    // Nothing is told of it before, as that it was taken.
    std::string reported;
    while (reported.find("ROSCELL_PARAMETERS_REFUSED=") == std::string::npos) {
      const auto next = node.receive();
      REQUIRE(next);
      reported += *next + "\n";
    }
    CHECK_THAT(reported, !Contains("ROSCELL_PARAMETERS_TAKEN"));
    CHECK_THAT(reported,
               Contains("ROSCELL_PARAMETERS_REFUSED=42 a word of at most "
                        "three letters is needed"));
    write_line("{\"number\":43,\"parameters\":{\"word\":7}}\n");
    CHECK(node.wait_for("ROSCELL_PARAMETERS_REFUSED=43 parameter 'word' must "
                        "be a text"));
    prompt.set();
    CHECK(has_come(log.second));
  });
  CHECK(log.text == "a1 a2 ");
}

TEST_CASE_METHOD(tuned_skill,
                 "an executor that takes no parameters refuses them") {
  env.model = "fixed";
  run_until([&](auto&) {
    write_line("{\"number\":1,\"parameters\":{}}\n");
    CHECK(node.wait_for("ROSCELL_PARAMETERS_REFUSED=1 this skill does not take "
                        "parameters while it runs"));
  });
}

TEST_CASE_METHOD(tuned_skill, "lines that tell no parameters change nothing") {
  run_until([&](auto&) {
    for (const auto* line :
         {"", "{}", "[]", R"({"number":1})",
          R"({"number":"1","parameters":{}})",
          R"({"number":1,"parameters":[]})", R"({"number":1,"param)",
          R"({"number":-1,"parameters":{"word":"x"}})"})
      write_line(std::string{line} + "\n");
    write_line("{\"number\":2,\"parameters\":{\"word\":\"b\"}}\n");
    CHECK(node.wait_for("ROSCELL_PARAMETERS_TAKEN=2"));
  });
  CHECK(said.find("parameters: ") == said.rfind("parameters: "));
}

TEST_CASE_METHOD(tuned_skill,
                 "of parameters that come meanwhile the last ones count") {
  primitive_base_engine engine{parts, env, [](const std::string&) {}};
  engine.use_parameters({1, R"({"word":"b"})"});
  engine.use_parameters({2, R"({"word":"c"})"});
  std::thread runner{[&] { engine.run(); }};
  CHECK(node.wait_for("ROSCELL_PARAMETERS_TAKEN=2"));
  CHECK(has_come(log.first));
  engine.request_stop();
  runner.join();
  CHECK(log.text == "c1 ");
}

namespace {

/// Keeps what is answered to requests.
struct requesting_view : parameter_view {
  explicit requesting_view(logged_answers& a) : answers(a) {
    // nop
  }

  void open(const parameters&) override {
    // nop
  }

  void show(const parameters& now) override {
    answers.add("shown " + now.text("word", ""));
  }

  void on_answer(std::int64_t request, const std::string& problem) override {
    answers.add(std::to_string(request) + " " + problem);
  }

  void suspend() override {
    // nop
  }

  void resume(const changed_variables&) override {
    // nop
  }

  logged_answers& answers;
};

} // namespace

TEST_CASE_METHOD(tuned_skill,
                 "what a program asks for is told to the node, and the "
                 "answer comes after the change") {
  logged_answers answers;
  request_function request;
  env.changeable = "{\"word\":{}}";
  parts.set_parameter_view("prompted",
                           [&](const environment&, const say_function&,
                               const request_function& given) {
                             request = given;
                             return std::make_unique<requesting_view>(answers);
                           });
  run_until([&](auto&) {
    CHECK(request(std::string(3501, 'x')) == 0);
    const auto first = request("{\"word\":\"b\"}");
    CHECK(first > 0);
    CHECK(node.wait_for("ROSCELL_PARAMETERS_WANTED=" + std::to_string(first)
                        + " {\"word\":\"b\"}"));
    write_line("{\"number\":1,\"parameters\":{\"word\":\"b\"}}\n");
    CHECK(node.wait_for("ROSCELL_PARAMETERS_TAKEN=1"));
    write_line("{\"request\":" + std::to_string(first)
               + ",\"problem\":\"\"}\n");
    CHECK(answers.wait_for(std::to_string(first) + " "));
    // No number comes again.
    CHECK(request("{}") > first);
    write_line("{\"request\":\"x\",\"problem\":\"\"}\n{\"request\":5}\n"
               "{\"request\":5,\"problem\":\"no\"}\n");
    CHECK(answers.wait_for("5 no"));
  });
  CHECK(answers.all().size() == 3);
  CHECK(answers.all().front() == "shown b");
}
