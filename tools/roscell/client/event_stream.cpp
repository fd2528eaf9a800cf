#include "tools/roscell/client/event_stream.hpp"

#include "tools/roscell/view/format.hpp"

#include <algorithm>
#include <cstdio>

namespace roscell::cli {

namespace {

/// An event is far smaller; more than this is a peer gone wrong.
constexpr size_t max_data_bytes = 4UL * 1024 * 1024;

constexpr size_t max_value_width = 60;

std::optional<event> decode(const std::string& text) {
  const auto document = json::parse(text, nullptr, false);
  if (!document.is_object())
    return std::nullopt;
  try {
    return document.get<event>();
  } catch (const json::exception&) {
    return std::nullopt;
  }
}

/// The particulars of an event; an empty object if there are none.
json particulars(const event& e) {
  auto data = json::parse(e.data, nullptr, false);
  return data.is_object() ? data : json::object();
}

std::string value_text(const json& value) {
  if (value.is_string())
    return value.get<std::string>();
  return value.dump(-1, ' ', false, json::error_handler_t::replace);
}

std::string text_at(const json& data, const char* key) {
  const auto found = data.find(key);
  return found != data.end() && found->is_string() ? found->get<std::string>()
                                                   : "";
}

std::string words(std::string what) {
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

} // namespace

std::optional<event> event_stream::add_line(std::string_view line) {
  if (!line.empty() && line.back() == '\r')
    line.remove_suffix(1);
  if (line.empty()) {
    auto complete = decode(data_);
    data_.clear();
    return complete;
  }
  constexpr std::string_view field = "data:";
  if (line.substr(0, field.size()) != field)
    return std::nullopt;
  line.remove_prefix(field.size());
  if (!line.empty() && line.front() == ' ')
    line.remove_prefix(1);
  if (data_.size() + line.size() < max_data_bytes)
    data_.append(line).append("\n");
  return std::nullopt;
}

std::string event_heading() {
  return "TIME                        SEQ  EVENT                 SUBJECT";
}

std::string event_line(const event& e) {
  std::array<char, 24> sequence{};
  std::snprintf(sequence.data(), sequence.size(), "%7llu",
                static_cast<unsigned long long>(e.sequence));
  auto padded = [](std::string text, size_t width) {
    text.resize(text.size() + width - std::min(width, display_width(text)),
                ' ');
    return text;
  };
  const auto rest = event_particulars(e);
  auto line = format_time(e.time_unix_ms) + " " + sequence.data() + "  "
              + padded(e.what, 20) + "  ";
  line += rest.empty() ? e.subject : padded(e.subject, 16) + "  " + rest;
  return printable(line);
}

std::string event_particulars(const event& e) {
  std::string line;
  const auto data = particulars(e);
  for (const auto& [key, value] : data.items())
    if (!value.is_null() && !(value.is_string() && value.empty()))
      line += (line.empty() ? "" : " ") + key + "="
              + shortened(value_text(value), max_value_width);
  return line;
}

std::string event_text(const event& e, const char* key) {
  return text_at(particulars(e), key);
}

std::vector<std::string> progress_lines(const event& e,
                                        const std::string& task) {
  const auto data = particulars(e);
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
  auto line = step.empty() ? words(e.what)
                           : "step " + step + ": "
                                 + (state.empty() ? words(e.what) : state)
                                 + " on " + node;
  if (!reason.empty())
    line += ": " + reason;
  return {printable(line)};
}

std::vector<std::string> movement_lines(const event& e,
                                        const std::vector<std::string>& nodes) {
  if (std::find(nodes.begin(), nodes.end(), e.subject) == nodes.end())
    return {};
  auto line = e.subject + ": " + words(e.what);
  const auto data = particulars(e);
  for (const auto* key : {"state", "reason"})
    if (const auto text = text_at(data, key); !text.empty())
      line += ": " + text;
  return {printable(line)};
}

} // namespace roscell::cli
