#include "client/event_stream.hpp"

namespace roscell {

namespace {

/// An event is far smaller; more than this is a peer gone wrong.
constexpr size_t max_data_bytes = 4UL * 1024 * 1024;

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

} // namespace roscell
