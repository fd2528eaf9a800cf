#include "roscell/skill/run.hpp"

#include "roscell/skill/log_line.hpp"
#include "skills/engine/life/signal_watch.hpp"
#include "skills/engine/primitive_base_engine.hpp"

#include <iostream>

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

} // namespace roscell::engine
