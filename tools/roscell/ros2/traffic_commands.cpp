#include "skills/ros2/topic_listener.hpp"
#include "tools/roscell/commands.hpp"
#include "tools/roscell/exit_code.hpp"
#include "tools/roscell/ros2/found_topic.hpp"
#include "tools/roscell/ros2/traffic_meter.hpp"
#include "tools/roscell/service_signals.hpp"
#include "tools/roscell/view/terminal.hpp"

#include <CLI/CLI.hpp>

#include <memory>
#include <mutex>
#include <string>

namespace roscell::cli {

namespace {

struct measure_options {
  topic_choice choice;
  std::string output = "text";
  uint64_t window = 10000; ///< Messages.
  double seconds = 0;      ///< 0: until Ctrl-C.
};

/// A meter that threads of Fast DDS fill.
class shared_meter {
public:
  using clock = traffic_meter::clock;

  explicit shared_meter(std::size_t window) : meter_{window, clock::now()} {}

  void add(const ros2::heard_message& x) {
    const auto age = std::chrono::system_clock::now() - x.sent;
    const std::lock_guard guard{mutex_};
    meter_.add(clock::now(), x.payload.size(), age);
  }

  std::string report(bool as_json) {
    const std::lock_guard guard{mutex_};
    return as_json ? compact(traffic_json(meter_, clock::now()))
                   : traffic_line(meter_, clock::now());
  }

private:
  std::mutex mutex_;
  traffic_meter meter_;
};

int measure(const measure_options& options) {
  stop_signals signals;
  const auto found = find_topic(options.choice);
  shared_meter meter{options.window};
  const ros2::topic_listener listener{
      found.config, found.row.topic, found.row.data_type, found.qos,
      [&](const ros2::heard_message& x) { meter.add(x); }};
  const auto ends = traffic_meter::clock::now()
                    + std::chrono::milliseconds{static_cast<int64_t>(
                        options.seconds > 0 ? options.seconds * 1000 : 1e12)};
  while (traffic_meter::clock::now() < ends
         && signals.wait_for(traffic_print_period)
                == stop_signals::cause::timeout)
    print(meter.report(options.output == "json"));
  return exit_done;
}

void add_measure_command(CLI::App& app, action& chosen, const char* name,
                         const char* description) {
  auto options = std::make_shared<measure_options>();
  auto* command = app.add_subcommand(name, description);
  command->footer(std::string{"Prints a line a second until Ctrl-C: rate, the "
                              "gaps between messages, bandwidth, and how\nlong "
                              "ago they were sent, by both hosts' clocks; or "
                              "how long nothing came.\n\n"
                              "Examples:\n  roscell "}
                  + name + " /fleet/camera/image\n  roscell " + name
                  + " /tf --seconds 5 -o json");
  add_topic_choice(*command, options->choice);
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
    chosen = [options] { return listen([&] { return measure(*options); }); };
  });
}

} // namespace

void add_traffic_commands(CLI::App& app, action& chosen) {
  add_measure_command(app, chosen, "hz",
                      "Measure how often a ROS 2 topic of the cell comes.");
  add_measure_command(app, chosen, "bw",
                      "Measure how many bytes a ROS 2 topic of the cell has.");
}

} // namespace roscell::cli
