#include "tools/roscell/view/terminal.hpp"

#include "messages/failure.hpp"
#include "tools/roscell/exit_code.hpp"
#include "tools/roscell/view/format.hpp"

#include <sys/ioctl.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <sstream>

namespace roscell::cli {

bool stdout_is_terminal() {
  return isatty(STDOUT_FILENO) == 1;
}

bool stderr_is_terminal() {
  return isatty(STDERR_FILENO) == 1;
}

text_style stdout_style() {
  text_style style;
  if (!stdout_is_terminal())
    return style;
  const auto* no_colour = std::getenv("NO_COLOR");
  const auto* term = std::getenv("TERM");
  const bool dumb = term == nullptr || std::strcmp(term, "dumb") == 0;
  style.colour = !dumb && (no_colour == nullptr || *no_colour == '\0');
  winsize size{};
  if (ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0)
    style.width = size.ws_col;
  return style;
}

view_style view_style_now() {
  using namespace std::chrono;
  const auto now = system_clock::now().time_since_epoch();
  return {stdout_style(), duration_cast<milliseconds>(now).count()};
}

void print(std::string_view text) {
  std::fwrite(text.data(), 1, text.size(), stdout);
  if (std::fflush(stdout) != 0)
    throw command_error{exit_refused, "cannot write to standard output: "
                                          + std::string{std::strerror(errno)}};
}

void print_text(std::string_view lines) {
  std::fwrite(lines.data(), 1, lines.size(), stderr);
}

void print_note(std::string_view line) {
  print_text(std::string{line} + '\n');
}

std::string shortened_line(const std::string& line) {
  const auto width = stdout_style().width;
  return width == 0 ? line : shortened(line, width);
}

void end_quietly_on_interrupt() {
  struct sigaction ending {};
  ending.sa_handler = [](int) { _exit(exit_done); };
  sigaction(SIGINT, &ending, nullptr);
  sigaction(SIGTERM, &ending, nullptr);
}

std::string pretty(const json& document) {
  return document.dump(2, ' ', false, json::error_handler_t::replace) + "\n";
}

std::string compact(const json& document) {
  return document.dump(-1, ' ', false, json::error_handler_t::replace) + "\n";
}

void print_error(const std::string& what, const std::string& hint) {
  print_note("roscell: " + printable(what));
  if (!hint.empty())
    print_note("hint: " + printable(hint));
}

namespace {

/// Every place that breaks the schema, if the refusal lists several.
void print_places(const std::string& details) {
  const auto parsed = json::parse(details, nullptr, false);
  if (!parsed.is_object() || !parsed.contains("errors"))
    return;
  const auto& errors = parsed["errors"];
  if (!errors.is_array() || errors.size() < 2)
    return;
  for (const auto& e : errors)
    if (e.is_object())
      print_note("  " + printable(e.value("where", "")) + ": "
                 + printable(e.value("expected", "")));
}

} // namespace

void print_log_tail(const std::string& details) {
  const auto parsed = json::parse(details, nullptr, false);
  const auto said =
      parsed.is_object() ? parsed.value("log_tail", json{}) : json{};
  if (!said.is_string() || said.get_ref<const std::string&>().empty())
    return;
  print_note("the last lines of its log:");
  std::istringstream lines{said.get<std::string>()};
  for (std::string line; std::getline(lines, line);)
    print_note("  " + printable(line));
}

void print_refusal(const json& reply) {
  const auto why = failure_from(reply);
  auto text = why.message + " (" + to_string(why.code) + ")";
  if (!why.where.empty())
    text += " at " + why.where;
  print_error(text);
  print_places(why.details);
  print_log_tail(why.details);
  if (!why.hint.empty())
    print_note("hint: " + printable(why.hint));
}

} // namespace roscell::cli
