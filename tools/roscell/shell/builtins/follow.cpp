#include "tools/roscell/exit_code.hpp"
#include "tools/roscell/shell/builtins/builtins.hpp"
#include "tools/roscell/view/format.hpp"
#include "tools/roscell/view/terminal.hpp"

#include <CLI/CLI.hpp>

#include <memory>
#include <optional>

namespace roscell::cli {

namespace {

struct follow_options {
  event_filter filter;
  bool off = false;
};

int begin_to_follow(const follow_options& options, live_shell* shell) {
  if (shell == nullptr)
    throw command_error{exit_usage,
                        "`follow` shows events above a line that is typed, and "
                        "nobody types here",
                        "`events` follows them as a command"};
  if (options.off) {
    shell->events.show(std::nullopt);
    print("events are not shown any more\n");
    return exit_done;
  }
  shell->events.show(options.filter);
  print("shows " + printable(options.filter.words())
        + "; `follow --off` ends it\n");
  return exit_done;
}

} // namespace

void add_follow_builtin(CLI::App& app, action& chosen, live_shell* shell) {
  auto options = std::make_shared<follow_options>();
  auto* word = app.add_subcommand(
      "follow", "Show events above the line that is typed, from now on.");
  word->group(own_announcement);
  word->footer("While a command runs they wait for its end.\n\n"
               "Examples:\n  follow\n  follow node_* task_failed\n"
               "  follow -s arm-1 -s fleet-poses\n  follow --off");
  word->add_option("KIND", options->filter.kinds,
                   "Only such events; with a * at the end all whose name "
                   "begins so")
      ->option_text(" ");
  word->add_option("-s,--subject", options->filter.subjects,
                   "Only those about this node, task, step or instance; can "
                   "be repeated")
      ->option_text("NAME")
      ->expected(1)
      ->take_all();
  word->add_flag("--off", options->off, "Show none from now on");
  word->callback([&chosen, options, shell] {
    chosen = [options, shell] { return begin_to_follow(*options, shell); };
  });
}

} // namespace roscell::cli
