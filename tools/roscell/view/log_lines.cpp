#include "tools/roscell/view/log_lines.hpp"

#include "tools/roscell/view/format.hpp"

#include <algorithm>

namespace roscell::cli {

namespace {

/// A line that is longer is shown in parts.
constexpr size_t longest_kept = 1024 * 1024;

/// Bytes of the colour that `text` begins with, "\x1b[1;31m"; 0: it is none.
size_t colour_length(std::string_view text) {
  constexpr std::string_view begin = "\x1b[";
  if (text.substr(0, begin.size()) != begin)
    return 0;
  const auto end = text.find_first_not_of("0123456789;:", begin.size());
  return end != text.npos && text[end] == 'm' ? end + 1 : 0;
}

} // namespace

std::string harmless_line(std::string_view line) {
  std::string result;
  if (!line.empty() && line.back() == '\r')
    line.remove_suffix(1);
  while (!line.empty()) {
    auto length = colour_length(line);
    if (length == 0) {
      const bool is_tab = line.front() == '\t';
      length =
          is_tab ? 1 : std::min(line.find_first_of("\t\x1b", 1), line.size());
      result += is_tab ? "\t" : printable(line.substr(0, length));
    }
    line.remove_prefix(length);
  }
  return result;
}

namespace {

std::string harmless_lines(std::string_view lines) {
  std::string result;
  while (!lines.empty()) {
    const auto newline = std::min(lines.find('\n'), lines.size());
    result += harmless_line(lines.substr(0, newline));
    if (newline < lines.size())
      result += '\n';
    lines.remove_prefix(std::min(newline + 1, lines.size()));
  }
  return result;
}

} // namespace

std::string log_lines::add(std::string_view part) {
  if (reader_ == log_reader::program)
    return prefixed(part);
  kept_ += part;
  auto end = kept_.rfind('\n') + 1;
  if (end == 0 && kept_.size() > longest_kept)
    end = kept_.size();
  const auto whole = kept_.substr(0, end);
  kept_.erase(0, end);
  return prefixed(harmless_lines(whole));
}

std::string log_lines::finish() {
  return prefixed(harmless_lines(std::exchange(kept_, {})));
}

std::string log_lines::prefixed(std::string_view part) {
  std::string result;
  while (!part.empty()) {
    const auto newline = part.find('\n');
    const bool open = newline == std::string_view::npos;
    const auto line = part.substr(0, open ? part.size() : newline + 1);
    if (!in_line_)
      result += prefix_;
    result += line;
    in_line_ = open;
    part.remove_prefix(line.size());
  }
  return result;
}

namespace {

/// Its state, its exit code and why it ended.
std::string end_text(const kept_log& log) {
  std::string result{to_string(log.state)};
  if (log.exit_code >= 0)
    result += " (" + std::to_string(log.exit_code) + ')';
  return log.reason.empty() ? result : result + ": " + log.reason;
}

} // namespace

std::string kept_logs_view(const kept_logs& logs, const view_style& style) {
  table t{{{"INSTANCE"},
           {"TASK", align::left, 4, true},
           {"NODE", align::left, 3, true},
           {"ENDED", align::right},
           {"HOW", align::left, 1},
           {"SIZE", align::right, 2, true}},
          {}};
  for (const auto& x : logs.logs)
    t.rows.push_back({x.instance, x.task, x.node,
                      format_since(x.ended_unix_ms, style.now_unix_ms),
                      end_text(x), format_bytes(static_cast<double>(x.bytes))});
  auto text = or_nothing(t, "logs of instances that are gone", style);
  if (logs.unreadable > 0)
    text += std::to_string(logs.unreadable) + " more cannot be read\n";
  if (!logs.silent.empty())
    text += "without those of " + printable(joined(logs.silent, ", "))
            + ", away, silent or of an earlier version\n";
  return text;
}

} // namespace roscell::cli
