#include "skills/ros2/topic_listener.hpp"
#include "tools/roscell/commands.hpp"
#include "tools/roscell/exit_code.hpp"
#include "tools/roscell/ros2/echo/message_value.hpp"
#include "tools/roscell/ros2/found_topic.hpp"
#include "tools/roscell/service_signals.hpp"
#include "tools/roscell/view/terminal.hpp"

#include <CLI/CLI.hpp>

#include <cstdlib>
#include <memory>
#include <string>

namespace roscell::cli {

namespace {

struct echo_options {
  topic_choice choice;
  std::string output = "text";
  uint64_t count = 0;  ///< Messages; 0: until Ctrl-C.
  uint64_t items = 32; ///< Of a sequence that are shown.
};

/// Prints messages as they come, on a thread of Fast DDS.
class message_printer {
public:
  message_printer(const echo_options& options, std::string type,
                  stop_signals& signals)
      : options_{options}, type_{std::move(type)}, signals_{signals},
        library_{prefixes_in(text_of_variable("AMENT_PREFIX_PATH"))} {
    library_.find(type_);
  }

  void print_message(const ros2::heard_message& x) {
    if (done_)
      return;
    try {
      const auto value =
          message_value(library_, type_, x.payload, options_.items);
      print(options_.output == "json" ? compact_value(value)
                                      : value_text(value) + "---\n");
    } catch (const std::exception& why) {
      problem_ = why.what();
    }
    done_ = !problem_.empty() || ++printed_ == options_.count;
    if (done_)
      signals_.end();
  }

  /// Why nothing more could be printed; empty: nothing was wrong. To be asked
  /// when nobody prints any more.
  const std::string& problem() const {
    return problem_;
  }

private:
  static std::string text_of_variable(const char* name) {
    const auto* value = std::getenv(name);
    return value != nullptr ? value : "";
  }

  static std::string compact_value(const message_json_value& x) {
    using handler = message_json_value::error_handler_t;
    return x.dump(-1, ' ', false, handler::replace) + "\n";
  }

  const echo_options& options_;
  const std::string type_;
  stop_signals& signals_;
  message_library library_;
  std::string problem_;
  uint64_t printed_ = 0;
  bool done_ = false;
};

int echo(const echo_options& options) {
  stop_signals signals;
  const auto found = find_topic(options.choice);
  message_printer printer{options, found.row.data_type, signals};
  auto listener = std::make_unique<ros2::topic_listener>(
      found.config, found.row.topic, found.row.data_type, found.qos,
      [&](const ros2::heard_message& x) { printer.print_message(x); });
  signals.wait();
  listener.reset();
  if (!printer.problem().empty())
    throw command_error{exit_refused, printer.problem()};
  return exit_done;
}

int run(const echo_options& options) {
  try {
    return listen([&] { return echo(options); });
  } catch (const definition_error& why) {
    throw command_error{exit_refused, why.what()};
  }
}

} // namespace

void add_echo_command(CLI::App& app, action& chosen) {
  auto options = std::make_shared<echo_options>();
  auto* command = app.add_subcommand(
      "echo", "Print the messages of a ROS 2 topic of the cell.");
  command->footer(
      "Types of common packages are known; others are looked up in the "
      "workspaces of AMENT_PREFIX_PATH.\nEnds by Ctrl-C.\n\n"
      "Examples:\n  roscell echo /tf --count 1\n"
      "  roscell echo /fleet/camera/camera_info -o json");
  add_topic_choice(*command, options->choice);
  command
      ->add_option("--count", options->count,
                   "End after so many messages; 0: only by Ctrl-C")
      ->capture_default_str()
      ->option_text("N");
  command
      ->add_option("--items", options->items,
                   "Of each sequence show so many items")
      ->capture_default_str()
      ->option_text("N");
  command
      ->add_option(
          "-o,--output", options->output,
          "text: YAML, as `ros2 topic echo`; json: one document a line")
      ->check(CLI::IsMember({"text", "json"}))
      ->capture_default_str()
      ->option_text("FORMAT");
  command->callback(
      [&chosen, options] { chosen = [options] { return run(*options); }; });
}

} // namespace roscell::cli
