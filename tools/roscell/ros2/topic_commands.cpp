#include "messages/node.hpp"
#include "messages/topic.hpp"
#include "skills/engine/errors.hpp"
#include "skills/ros2/topic_listener.hpp"
#include "tools/roscell/client/node_client.hpp"
#include "tools/roscell/commands.hpp"
#include "tools/roscell/daemon/stop_signals.hpp"
#include "tools/roscell/exit_code.hpp"
#include "tools/roscell/ros2/echo/message_value.hpp"
#include "tools/roscell/ros2/traffic_meter.hpp"
#include "tools/roscell/view/format.hpp"
#include "tools/roscell/view/terminal.hpp"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cstdlib>
#include <memory>
#include <mutex>
#include <string>

namespace roscell::cli {

namespace {

using namespace std::chrono_literals;

constexpr std::chrono::seconds query_limit{10};

/// How often figures are printed, as by `ros2 topic hz`.
constexpr std::chrono::seconds print_period{1};

struct listen_options {
  connection_options connection;
  std::string topic;
  std::string output = "text";
  uint64_t window = 10000; ///< Messages.
  double seconds = 0;      ///< 0: until Ctrl-C.
  uint64_t count = 0;      ///< Messages; 0: until Ctrl-C.
  uint64_t items = 32;     ///< Of a sequence that are shown.
};

using options_ptr = std::shared_ptr<listen_options>;

/// A topic and how its cell is entered.
struct found_topic {
  topic_row row;
  ros2::participant_config config;
};

topic_row row_of(const node_client& node, const std::string& topic) {
  topic_query query;
  query.topic = topic;
  auto rows =
      node.ask(message_json(query), query_limit).get<topic_list>().topics;
  const auto written = std::find_if(rows.begin(), rows.end(),
                                    [](auto& x) { return !x.writers.empty(); });
  if (written == rows.end())
    throw command_error{exit_refused,
                        "nobody in the cell writes the topic '" + topic + "'",
                        "`roscell topics` lists what there is"};
  return *written;
}

found_topic find_topic(const listen_options& options) {
  const node_client node{options.connection};
  const auto environment =
      node.get("/v1/node").get<node_description>().environment;
  if (environment.empty())
    throw command_error{exit_refused, "this node is in no cell, or not yet",
                        "`roscell status` shows where it stands"};
  const auto lookup = [&](const char* name) -> const char* {
    if (name == std::string{"ROSCELL_OPERATION"})
      return "roscell_listener";
    const auto i = environment.find(name);
    return i == environment.end() ? nullptr : i->second.c_str();
  };
  return {row_of(node, options.topic),
          ros2::read_participant_config(lookup, engine::parameters{})};
}

/// Matches every writer, and asks for no more than all of them offer.
ros2::topic_qos qos_for(const topic_row& row) {
  ros2::topic_qos result;
  for (const auto& x : row.writers)
    result.reliable = result.reliable && x.reliability == "reliable";
  return result;
}

std::string line_of(const traffic_figures& x) {
  return format_number(x.rate_hz, 2) + " Hz, gaps "
         + format_number(x.least_gap_ms, 1) + " to "
         + format_number(x.most_gap_ms, 1) + " ms (deviation "
         + format_number(x.gap_deviation_ms, 1) + "), "
         + format_bytes(x.bytes_per_s) + "/s in messages of "
         + format_bytes(x.mean_bytes) + ", " + format_number(x.median_age_ms, 2)
         + " ms old, window " + std::to_string(x.messages) + "\n";
}

json json_of(const traffic_figures& x) {
  return {{"messages", x.messages},
          {"rate_hz", x.rate_hz},
          {"least_gap_ms", x.least_gap_ms},
          {"most_gap_ms", x.most_gap_ms},
          {"gap_deviation_ms", x.gap_deviation_ms},
          {"bytes_per_s", x.bytes_per_s},
          {"mean_bytes", x.mean_bytes},
          {"median_age_ms", x.median_age_ms}};
}

/// A meter that threads of Fast DDS fill.
class shared_meter {
public:
  explicit shared_meter(std::size_t window) : meter_{window} {}

  void add(const ros2::heard_message& x) {
    const auto age = std::chrono::system_clock::now() - x.sent;
    const std::lock_guard guard{mutex_};
    meter_.add(traffic_meter::clock::now(), x.payload.size(), age);
  }

  std::optional<traffic_figures> figures() {
    const std::lock_guard guard{mutex_};
    return meter_.figures();
  }

private:
  std::mutex mutex_;
  traffic_meter meter_;
};

int measure(const listen_options& options) {
  stop_signals signals;
  const auto found = find_topic(options);
  shared_meter meter{options.window};
  const ros2::topic_listener listener{
      found.config, found.row.topic, found.row.data_type, qos_for(found.row),
      [&](const ros2::heard_message& x) { meter.add(x); }};
  const auto ends = traffic_meter::clock::now()
                    + std::chrono::milliseconds{static_cast<int64_t>(
                        options.seconds > 0 ? options.seconds * 1000 : 1e12)};
  while (traffic_meter::clock::now() < ends
         && signals.wait_for(print_period) == stop_signals::cause::timeout) {
    const auto x = meter.figures();
    if (options.output == "json")
      print(compact(x ? json_of(*x) : json{{"messages", 0}}));
    else
      print(x ? line_of(*x) : std::string{"nothing yet\n"});
  }
  return exit_done;
}

/// Prints messages as they come, on a thread of Fast DDS.
class message_printer {
public:
  message_printer(const listen_options& options, std::string type,
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
      trouble_ = why.what();
    }
    done_ = !trouble_.empty() || ++printed_ == options_.count;
    if (done_)
      signals_.end();
  }

  /// Why nothing more could be printed; empty: nothing was wrong. To be asked
  /// when nobody prints any more.
  const std::string& trouble() const {
    return trouble_;
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

  const listen_options& options_;
  const std::string type_;
  stop_signals& signals_;
  message_library library_;
  std::string trouble_;
  uint64_t printed_ = 0;
  bool done_ = false;
};

int echo(const listen_options& options) {
  stop_signals signals;
  const auto found = find_topic(options);
  message_printer printer{options, found.row.data_type, signals};
  auto listener = std::make_unique<ros2::topic_listener>(
      found.config, found.row.topic, found.row.data_type, qos_for(found.row),
      [&](const ros2::heard_message& x) { printer.print_message(x); });
  signals.wait();
  listener.reset();
  if (!printer.trouble().empty())
    throw command_error{exit_refused, printer.trouble()};
  return exit_done;
}

int run(const options_ptr& options, int (*command)(const listen_options&)) {
  try {
    return command(*options);
  } catch (const definition_error& why) {
    throw command_error{exit_refused, why.what()};
  } catch (const engine::start_error& why) {
    throw command_error{exit_refused, why.what()};
  }
}

void add_measure_command(CLI::App& app, action& chosen, const char* name,
                         const char* description) {
  auto options = std::make_shared<listen_options>();
  auto* command = app.add_subcommand(name, description);
  command->footer(std::string{"Prints a line a second until Ctrl-C: rate, the "
                              "gaps between messages, bandwidth, and how\nlong "
                              "ago they were sent, by both hosts' clocks.\n\n"
                              "Examples:\n  roscell "}
                  + name + " /fleet/camera/image\n  roscell " + name
                  + " /tf --seconds 5 -o json");
  add_connection_options(*command, options->connection);
  command->add_option("TOPIC", options->topic, "Its name")
      ->required()
      ->option_text(" ");
  command
      ->add_option("--window", options->window,
                   "Messages that are measured, the last ones")
      ->check(CLI::Range(2, 1000000))
      ->capture_default_str()
      ->option_text("N");
  command
      ->add_option("--seconds", options->seconds,
                   "End after so long; 0: only by Ctrl-C")
      ->check(CLI::Range(0.0, 1e9))
      ->capture_default_str()
      ->option_text("S");
  command
      ->add_option("-o,--output", options->output,
                   "text, or json: one document a line")
      ->check(CLI::IsMember({"text", "json"}))
      ->capture_default_str()
      ->option_text("FORMAT");
  command->callback([&chosen, options] {
    chosen = [options] { return run(options, measure); };
  });
}

void add_echo_command(CLI::App& app, action& chosen) {
  auto options = std::make_shared<listen_options>();
  auto* command = app.add_subcommand(
      "echo", "Print the messages of a ROS 2 topic of the cell.");
  command->footer(
      "Types of common packages are known; others are looked up in the "
      "workspaces of AMENT_PREFIX_PATH.\nEnds by Ctrl-C.\n\n"
      "Examples:\n  roscell echo /tf --count 1\n"
      "  roscell echo /fleet/camera/camera_info -o json");
  add_connection_options(*command, options->connection);
  command->add_option("TOPIC", options->topic, "Its name")
      ->required()
      ->option_text(" ");
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
  command->callback([&chosen, options] {
    chosen = [options] { return run(options, echo); };
  });
}

} // namespace

void add_topic_commands(CLI::App& app, action& chosen) {
  add_echo_command(app, chosen);
  add_measure_command(app, chosen, "hz",
                      "Measure how often a ROS 2 topic of the cell comes.");
  add_measure_command(app, chosen, "bw",
                      "Measure how many bytes a ROS 2 topic of the cell has.");
}

} // namespace roscell::cli
