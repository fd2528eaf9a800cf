#include "tools/roscell/view/event_text.hpp"

#include "actors/edge/io/node_time.hpp"
#include "messages/event_kinds.hpp"
#include "tools/roscell/view/format.hpp"

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cstdio>
#include <ctime>
#include <optional>
#include <stdexcept>
#include <string_view>
#include <system_error>

namespace roscell::cli {

namespace {

constexpr size_t max_value_width = 60;

/// The particulars of an event; an empty object if there are none.
json particulars(const event& e) {
  auto data = json::parse(e.data, nullptr, false);
  return data.is_object() ? data : json::object();
}

std::string value_text(const json& value);

/// The elements of an array, or the members of an object, in one line.
std::string inner_text(const json& value) {
  std::vector<std::string> parts;
  for (const auto& [key, inner] : value.items()) {
    const auto text = value_text(inner);
    parts.push_back(value.is_object() ? key + " " + text : text);
  }
  return joined(parts, ", ");
}

/// A value as people write it.
std::string value_text(const json& value) {
  if (value.is_string())
    return value.get<std::string>();
  if (value.is_boolean())
    return value.get<bool>() ? "yes" : "no";
  if (value.is_number_float())
    return format_significant(value.get<double>(), 4);
  if (!value.is_structured())
    return value.dump(-1, ' ', false, json::error_handler_t::replace);
  return "(" + inner_text(value) + ")";
}

std::string text_at(const json& data, const char* key) {
  const auto found = data.find(key);
  return found != data.end() && found->is_string() ? found->get<std::string>()
                                                   : "";
}

std::string spaced(std::string what) {
  std::replace(what.begin(), what.end(), '_', ' ');
  return what;
}

/// Where the allocation puts each step.
std::vector<std::string> placements(const json& data) {
  const auto found = data.find("allocations");
  if (found == data.end() || !found->is_array())
    return {};
  std::vector<std::string> lines;
  for (const auto& a : *found)
    if (a.is_object())
      lines.push_back(printable("step " + text_at(a, "step") + ": placed on "
                                + text_at(a, "node") + " ("
                                + text_at(a, "deployment") + ")"));
  return lines;
}

/// "camera→head, poses→arm"; empty if the value is no allocation.
std::string placement_text(const json& value) {
  std::vector<std::string> parts;
  if (value.is_array())
    for (const auto& a : value)
      if (a.is_object() && a.contains("step") && a.contains("node"))
        parts.push_back(text_at(a, "step") + "→" + text_at(a, "node"));
  return joined(parts, ", ");
}

/// "camera_1 starting on arm-1"; the task is in the instance's id.
std::string change_text(const json& data) {
  const auto step = text_at(data, "step");
  const auto state = text_at(data, "state");
  const auto node = text_at(data, "node");
  if (step.empty() || state.empty())
    return {};
  return step + " " + state + (node.empty() ? "" : " on " + node);
}

/// One particular of an event; empty if it says nothing.
std::string particular(const std::string& key, const json& value) {
  if (value.is_null() || (value.is_string() && value.get<std::string>().empty())
      || (value.is_structured() && value.empty()))
    return {};
  if (key == "allocations")
    if (auto text = placement_text(value); !text.empty())
      return text;
  // Of a score people want the total.
  if (key == "score" && value.is_object() && value.contains("total"))
    return "score=" + value_text(value["total"]);
  return key + "=" + shortened(value_text(value), max_value_width);
}

/// Of the date in "2026-11-21 14:03:07.250", and the blank behind it.
constexpr size_t date_width = 11;

/// Of a terminal on which a line with its date has room for what it says.
constexpr size_t roomy_width = 120;

bool is_narrow(size_t width) {
  return width != 0 && width < roomy_width;
}

std::string padded(std::string text, size_t width) {
  text.resize(text.size() + width - std::min(width, display_width(text)), ' ');
  return text;
}

/// The step is told with what has become of it, so the task says the rest.
std::string subject_of(const event& e) {
  const auto data = particulars(e);
  const auto task = text_at(data, "task");
  return change_text(data).empty() || task.empty() ? e.subject : task;
}

} // namespace

std::string event_heading(size_t width) {
  const std::string heading =
      "TIME                        SEQ  EVENT                 SUBJECT";
  return is_narrow(width) ? "TIME" + heading.substr(4 + date_width) : heading;
}

std::string event_line(const event& e, size_t width) {
  std::array<char, 24> sequence{};
  std::snprintf(sequence.data(), sequence.size(), "%7llu",
                static_cast<unsigned long long>(e.sequence));
  const auto time = local_time(e.time_unix_ms);
  const auto rest = event_particulars(e);
  const auto subject = subject_of(e);
  auto line = (is_narrow(width) ? time.substr(date_width) : time) + " "
              + sequence.data() + "  " + padded(e.what, 20) + "  ";
  line += rest.empty() ? subject : padded(subject, 16) + "  " + rest;
  return printable(line);
}

std::string event_particulars(const event& e) {
  std::vector<std::string> parts;
  auto data = particulars(e);
  if (e.what == events::instance_changed)
    if (auto change = change_text(data); !change.empty()) {
      parts.push_back(std::move(change));
      for (const auto* key : {"step", "state", "node", "task"})
        data.erase(key);
    }
  for (const auto& [key, value] : data.items())
    if (auto text = particular(key, value); !text.empty())
      parts.push_back(std::move(text));
  return joined(parts, " ");
}

std::string event_text(const event& e, const char* key) {
  return text_at(particulars(e), key);
}

bool is_on_the_way(const event& e, node_role asked) {
  if (e.what != events::instance_changed)
    return false;
  return event_text(e, "state") == to_string(instance_state::pending)
         || (asked == node_role::coordinator && event_text(e, "node").empty());
}

std::vector<std::string> progress_lines(const event& e,
                                        const std::string& task) {
  const auto data = particulars(e);
  if (text_at(data, "by") == task)
    return {printable(text_at(data, "task") + "/" + text_at(data, "step")
                      + " is preempted on " + text_at(data, "node"))};
  if (e.subject != task && text_at(data, "task") != task)
    return {};
  if (auto lines = placements(data); !lines.empty())
    return lines;
  const auto step = text_at(data, "step");
  const auto state = text_at(data, "state");
  const auto node = text_at(data, "node");
  const auto reason = text_at(data, "reason");
  // The coordinator's own node tells of its instances without saying where;
  // the coordinator then says it again for the cell.
  if (!step.empty() && node.empty())
    return {};
  auto line = step.empty() ? spaced(e.what)
                           : "step " + step + ": "
                                 + (state.empty() ? spaced(e.what) : state)
                                 + " on " + node;
  if (!reason.empty())
    line += ": " + reason;
  return {printable(line)};
}

std::vector<std::string> movement_lines(const event& e,
                                        const std::vector<std::string>& nodes) {
  if (std::find(nodes.begin(), nodes.end(), e.subject) == nodes.end())
    return {};
  auto line = e.subject + ": " + spaced(e.what);
  const auto data = particulars(e);
  for (const auto* key : {"state", "reason"})
    if (const auto text = text_at(data, key); !text.empty())
      line += ": " + text;
  return {printable(line)};
}

namespace {

constexpr int64_t ms_per_second = 1000;
constexpr int64_t seconds_per_day = 24 * 3600;

std::optional<uint64_t> whole_number(std::string_view text) {
  uint64_t result = 0;
  const auto [rest, error] =
      std::from_chars(text.data(), text.data() + text.size(), result);
  if (error != std::errc{} || rest != text.data() + text.size())
    return std::nullopt;
  return result;
}

std::optional<std::chrono::seconds> span_before(std::string_view text) {
  try {
    return parse_span(text);
  } catch (const std::invalid_argument&) {
    return std::nullopt;
  }
}

/// All of `text` in the form `format` of strptime.
std::optional<std::tm> parsed_as(const std::string& text, const char* format,
                                 const std::tm& unless_said) {
  auto result = unless_said;
  const auto* rest = ::strptime(text.c_str(), format, &result);
  if (rest == nullptr || *rest != '\0')
    return std::nullopt;
  return result;
}

/// Seconds since 1970 of what a clock on the wall shows here.
int64_t local_seconds(std::tm shown) {
  shown.tm_isdst = -1;
  return static_cast<int64_t>(std::mktime(&shown));
}

std::optional<int64_t> moment_of(std::string text, int64_t now_s) {
  const bool is_utc = !text.empty() && text.back() == 'Z';
  if (is_utc)
    text.pop_back();
  const std::tm midnight{};
  for (const auto* format : {"%Y-%m-%d", "%Y-%m-%d %H:%M", "%Y-%m-%dT%H:%M",
                             "%Y-%m-%d %H:%M:%S", "%Y-%m-%dT%H:%M:%S"})
    if (auto shown = parsed_as(text, format, midnight))
      return is_utc ? static_cast<int64_t>(::timegm(&*shown))
                    : local_seconds(*shown);
  const auto now = static_cast<std::time_t>(now_s);
  std::tm today{};
  ::localtime_r(&now, &today);
  today.tm_sec = 0;
  if (const auto shown = parsed_as(text, "%H:%M", today); shown && !is_utc) {
    const auto result = local_seconds(*shown);
    return result > now_s ? result - seconds_per_day : result;
  }
  return std::nullopt;
}

} // namespace

event_start parse_event_start(const std::string& text, int64_t now_unix_ms) {
  if (text == "start")
    return {};
  if (const auto number = whole_number(text))
    return {*number, 0, *number > 0};
  if (const auto span = span_before(text))
    return {0,
            std::max<int64_t>(1, now_unix_ms - span->count() * ms_per_second)};
  if (const auto moment = moment_of(text, now_unix_ms / ms_per_second))
    return {0, std::max<int64_t>(1, *moment * ms_per_second)};
  throw std::invalid_argument{
      "'" + text
      + "' is neither the number of an event, nor a span such as 2h or 7d, nor "
        "a moment such as 08:00 or '2026-11-25 08:00', nor start"};
}

} // namespace roscell::cli
