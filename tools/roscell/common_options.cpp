#include "tools/roscell/common_options.hpp"

#include "tools/roscell/view/format.hpp"

#include <CLI/CLI.hpp>

#include <stdexcept>

namespace roscell::cli {

namespace {

std::string check_duration(const std::string& text) {
  try {
    parse_duration(text);
    return {};
  } catch (const std::invalid_argument& e) {
    return e.what();
  }
}

} // namespace

void add_output_option(CLI::App& command, std::string& output) {
  command.add_option("-o,--output", output, "Form of what is printed")
      ->check(CLI::IsMember({"table", "json"}))
      ->option_text("table|json [table]");
}

void add_timeout_option(CLI::App& command, std::string& timeout) {
  command
      .add_option("--timeout", timeout,
                  "Longest wait for the reply, in seconds, or with a unit: "
                  "500ms, 2m, 1h")
      ->check(CLI::Validator{check_duration, "DURATION"})
      ->option_text("SECONDS [" + timeout + "]");
}

} // namespace roscell::cli
