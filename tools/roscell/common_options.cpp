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

void add_wide_output_option(CLI::App& command, std::string& output) {
  command
      .add_option("-o,--output", output,
                  "Form of what is printed: wide has all columns and cuts "
                  "nothing")
      ->check(CLI::IsMember({"table", "wide", "json"}))
      ->option_text("table|wide|json [table]");
}

void add_stream_output_option(CLI::App& command, std::string& output) {
  command
      .add_option("-o,--output", output,
                  "Form of what is printed; both JSON forms are one document "
                  "per line")
      ->check(CLI::IsMember({"table", "json", "jsonl"}))
      ->option_text("table|json|jsonl [table]");
}

void add_table_options(CLI::App& command, std::string& output,
                       table_options& tables) {
  command
      .add_option("-o,--output", output,
                  "Form of what is printed: wide has all columns and cuts "
                  "nothing, jsonl is one document per line")
      ->check(CLI::IsMember({"table", "wide", "json", "jsonl"}))
      ->option_text("table|wide|json|jsonl [table]");
  command.add_flag(
      "--no-headers", [&tables](int64_t) { tables.headings = false; },
      "Leave out the line of headings");
  command
      .add_option("--columns", tables.columns,
                  "Only these columns, named as in the headings")
      ->delimiter(',')
      ->option_text("A,B,C");
  command
      .add_option("--sort", tables.sort,
                  "Sort by this column, numbers by their value; --sort=-COLUMN "
                  "from its end")
      ->option_text("COLUMN");
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
