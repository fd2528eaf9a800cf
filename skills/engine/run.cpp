#include "roscell/skill/run.hpp"
#include "roscell/skill/log_line.hpp"
#include "roscell/skill/stop_event.hpp"
#include "roscell/skill/try_out.hpp"
#include "skills/engine/file/file_protocol.hpp"
#include "skills/engine/life/signal_watch.hpp"
#include "skills/engine/primitive_base_engine.hpp"

#include <unistd.h>

#include <algorithm>
#include <iostream>
#include <utility>

namespace roscell::engine {

namespace {

void say(const std::string& text) {
  log_line("engine: " + text);
}

int explain(const registry& parts, bool asked) {
  (asked ? std::cout : std::cerr)
      << "This is a ROSCell skill. A node starts it and tells it by "
         "environment "
         "variables\nwhat to do, see skills/README.md. It has "
      << parts.summary() << '\n';
  return static_cast<int>(asked ? exit_code::done : exit_code::cannot_start);
}

} // namespace

int run(const registry& parts, int argc, char** argv) {
  if (argc > 1)
    return explain(parts, argc == 2 && argv[1] == std::string{"--help"});
  try {
    block_signals();
    auto env = read_environment();
    primitive_base_engine engine{parts, env, say};
    signal_watch signals{[&] { engine.request_stop(); },
                         [&] { engine.want_safety(); }};
    return static_cast<int>(engine.run());
  } catch (...) {
    say("cannot start: " + current_error());
    return static_cast<int>(exit_code::cannot_start);
  }
}

namespace {

/// Keeps what is emitted.
class kept_results : public emitter {
public:
  std::vector<frame> results;

private:
  void write(frame result, std::size_t port) override {
    result.port = port;
    results.push_back(std::move(result));
  }
};

/// Gives each frame to the executor at once.
class direct_sink : public frame_sink {
public:
  direct_sink(executor& subject, const std::string& data_type, emitter& output)
      : subject_(subject), data_type_(data_type), output_(output) {
    // nop
  }

  bool push(frame input, when_full) override {
    input.data_type = data_type_;
    input.sequence = next_sequence_++;
    subject_.process(input, output_);
    return true;
  }

private:
  executor& subject_;
  const std::string& data_type_;
  emitter& output_;
  std::uint64_t next_sequence_ = 0;
};

} // namespace

std::vector<frame> try_out(executor& subject, const std::string& path,
                           const std::string& data_type) {
  const auto input = make_file_input({{"file", path, data_type},
                                      parameters::parse(R"({"follow": false})"),
                                      [](const std::string&) {}});
  kept_results output;
  direct_sink sink{subject, data_type, output};
  input->open();
  input->run(sink, stop_event{});
  subject.release();
  return std::move(output.results);
}

void log_line(std::string line) {
  std::replace_if(
      line.begin(), line.end(),
      [](char c) { return static_cast<unsigned char>(c) < ' ' || c == 127; },
      '?');
  line += '\n';
  [[maybe_unused]] auto n = ::write(STDERR_FILENO, line.data(), line.size());
}

} // namespace roscell::engine
