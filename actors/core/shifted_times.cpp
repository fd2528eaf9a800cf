#include "actors/core/shifted_times.hpp"

#include "actors/edge/io/node_time.hpp"
#include "schemas/document.hpp"

#include <algorithm>
#include <cstdlib>
#include <string_view>
#include <variant>

namespace roscell {

namespace {

constexpr std::string_view time_suffix = "unix_ms";
/// So far ahead of a moment are times that lie in the future on purpose, such
/// as the end of a pause.
constexpr int64_t planned_ms = 3'600'000;

bool is_time(const std::string& name, const json& value) {
  return value.is_number_integer() && name != "added_unix_ms"
         && name.size() >= time_suffix.size()
         && name.compare(name.size() - time_suffix.size(), time_suffix.size(),
                         time_suffix)
                == 0;
}

} // namespace

time_shift to_wall_clock() {
  const auto ahead = wall_clock_ahead_ms();
  const auto from = start_of_node_time().unix_ms - std::abs(ahead) / 2;
  return {std::max<int64_t>(1, from), node_time_ms() + planned_ms, ahead};
}

time_shift from_peer(int64_t ahead_ms) {
  return {1, node_time_ms() + planned_ms - ahead_ms, ahead_ms};
}

void shift_times(json& x, const time_shift& shift) {
  if (x.is_object())
    for (auto& [name, value] : x.items())
      if (is_time(name, value))
        value = shift(value.get<int64_t>());
  if (x.is_structured())
    for (auto& value : x)
      shift_times(value, shift);
}

std::string with_times_shifted(std::string text, const time_shift& shift) {
  if (shift.by == 0 || text.find(time_suffix) == std::string::npos)
    return text;
  auto parsed = parse_document(text);
  auto* document = std::get_if<json>(&parsed);
  if (document == nullptr)
    return text;
  shift_times(*document, shift);
  return document->dump(-1, ' ', false, json::error_handler_t::replace);
}

} // namespace roscell
