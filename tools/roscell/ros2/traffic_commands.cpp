#include "skills/ros2/topic_listener.hpp"
#include "tools/roscell/commands.hpp"
#include "tools/roscell/daemon/stop_signals.hpp"
#include "tools/roscell/exit_code.hpp"
#include "tools/roscell/ros2/found_topic.hpp"
#include "tools/roscell/ros2/traffic_meter.hpp"
#include "tools/roscell/view/format.hpp"
#include "tools/roscell/view/terminal.hpp"

#include <CLI/CLI.hpp>

#include <memory>
#include <mutex>
#include <string>

namespace roscell::cli {

namespace {

/// How often figures are printed, as by `ros2 topic hz`.
constexpr std::chrono::seconds print_period{1};

struct measure_options {
  topic_choice choice;
  std::string output = "text";
  uint64_t window = 10000; ///< Messages.
  double seconds = 0;      ///< 0: until Ctrl-C.
};

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
         && signals.wait_for(print_period) == stop_signals::cause::timeout) {
    const auto x = meter.figures();
    if (options.output == "json")
      print(compact(x ? json_of(*x) : json{{"messages", 0}}));
    else
      print(x ? line_of(*x) : std::string{"nothing yet\n"});
  }
  return exit_done;
}

void add_measure_command(CLI::App& app, action& chosen, const char* name,
                         const char* description) {
  auto options = std::make_shared<measure_options>();
  auto* command = app.add_subcommand(name, description);
  command->footer(std::string{"Prints a line a second until Ctrl-C: rate, the "
                              "gaps between messages, bandwidth, and how\nlong "
                              "ago they were sent, by both hosts' clocks.\n\n"
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
