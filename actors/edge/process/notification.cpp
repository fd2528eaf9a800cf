#include "actors/edge/process/notification.hpp"

#include "actors/edge/io/plain_text.hpp"
#include "schemas/utf8.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <utility>

namespace roscell {

namespace {

std::string bounded_text(std::string_view bytes, size_t most) {
  bytes = bytes.substr(0, most);
  bytes.remove_suffix(unfinished_utf8(bytes));
  auto result = valid_utf8(bytes);
  // Replacements are longer than what they replace.
  if (result.size() > most) {
    result.resize(most);
    result.resize(result.size() - unfinished_utf8(result));
  }
  std::replace_if(result.begin(), result.end(), is_control, ' ');
  return result;
}

/// What a line says after its name; none: it is another one.
std::optional<std::string_view> value_of(std::string_view line,
                                         std::string_view name) {
  if (line.substr(0, name.size()) != name)
    return std::nullopt;
  return line.substr(name.size());
}

/// 0 for what is no number of a change. The largest is what JSON carries
/// exactly.
int64_t change_number(std::string_view text) {
  constexpr int64_t most = 9'007'199'254'740'991;
  int64_t result = 0;
  const auto* end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, result);
  return error == std::errc{} && rest == end && result > 0 && result <= most
             ? result
             : 0;
}

/// "7 some text": takes the number off the front.
int64_t take_number(std::string_view& text) {
  const auto end = std::min(text.find(' '), text.size());
  const auto result = change_number(text.substr(0, end));
  text.remove_prefix(std::min(end + 1, text.size()));
  return result;
}

void read_refusal(std::string_view text, notification& result) {
  result.parameters_refused = take_number(text);
  if (result.parameters_refused > 0)
    result.refusal = bounded_text(text, max_refusal_bytes);
}

/// A datagram bounds how long it is; what it says is looked at by who carries
/// it out.
void read_request(std::string_view text, notification& result) {
  result.parameters_wanted = take_number(text);
  if (result.parameters_wanted > 0)
    result.wanted_parameters = bounded_text(text, max_notification_bytes);
}

void read_line(std::string_view line, notification& result) {
  if (line == "READY=1")
    result.ready = true;
  else if (line == "WATCHDOG=1")
    result.alive = true;
  else if (line == "STOPPING=1")
    result.stopping = true;
  else if (line == "ROSCELL_SAFE=1")
    result.safe = safe_word::safe;
  else if (line == "ROSCELL_SAFE=0")
    result.safe = safe_word::unsafe;
  else if (const auto status = value_of(line, "STATUS="))
    result.status = bounded_text(*status, max_status_bytes);
  else if (const auto streams = value_of(line, "ROSCELL_STREAMS="))
    result.streams = read_streams(*streams);
  else if (const auto frames = value_of(line, "ROSCELL_FRAMES="))
    result.frames = read_frames(*frames);
  else if (const auto remark = value_of(line, "ROSCELL_REMARK="))
    result.remark = bounded_text(*remark, max_remark_bytes);
  else if (const auto taken = value_of(line, "ROSCELL_PARAMETERS_TAKEN="))
    result.parameters_taken = change_number(*taken);
  else if (const auto refused = value_of(line, "ROSCELL_PARAMETERS_REFUSED="))
    read_refusal(*refused, result);
  else if (const auto wanted = value_of(line, "ROSCELL_PARAMETERS_WANTED="))
    read_request(*wanted, result);
}

} // namespace

notification parse_notification(std::string_view datagram) {
  notification result;
  if (datagram.size() > max_notification_bytes)
    return result;
  while (!datagram.empty()) {
    const auto end = datagram.find('\n');
    read_line(datagram.substr(0, end), result);
    datagram.remove_prefix(end == std::string_view::npos ? datagram.size()
                                                         : end + 1);
  }
  return result;
}

void merge(notification& before, notification later) {
  before.ready = before.ready || later.ready;
  before.alive = before.alive || later.alive;
  before.stopping = before.stopping || later.stopping;
  // What goes along with a status says nothing without it.
  if (!later.status.empty()) {
    before.status = std::move(later.status);
    before.frames = std::move(later.frames);
    before.remark = std::move(later.remark);
  }
  if (later.safe != safe_word::untold)
    before.safe = later.safe;
  if (!later.streams.empty())
    before.streams = std::move(later.streams);
  // Of several changes the last one counts, whatever became of the others.
  if (later.parameters_taken > before.parameters_taken)
    before.parameters_taken = later.parameters_taken;
  if (later.parameters_refused > before.parameters_refused) {
    before.parameters_refused = later.parameters_refused;
    before.refusal = std::move(later.refusal);
  }
  // A program has one such request at a time.
  if (later.parameters_wanted > 0) {
    before.parameters_wanted = later.parameters_wanted;
    before.wanted_parameters = std::move(later.wanted_parameters);
  }
}

namespace {

std::optional<double> parsed_number(std::string_view text) {
  double value = 0;
  const auto* end = text.data() + text.size();
  const auto [rest, error] =
      std::from_chars(text.data(), end, value, std::chars_format::fixed);
  if (error != std::errc{} || rest != end || !std::isfinite(value)
      || std::signbit(value))
    return std::nullopt;
  return value;
}

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

bool names_end(std::string_view text) {
  auto number = text;
  const auto direction = take_until(number, ':');
  return (direction == "input" || direction == "output") && !number.empty()
         && number.size() <= 2
         && std::all_of(number.begin(), number.end(), is_digit);
}

/// "input:0 12.5 0.040"
std::optional<stream_metrics> read_stream(std::string_view text) {
  const auto end = take_until(text, ' ');
  const auto rate_hz = parsed_number(take_until(text, ' '));
  const auto age_s =
      text == "-" ? std::optional<double>{-1} : parsed_number(text);
  if (!names_end(end) || !rate_hz || !age_s)
    return std::nullopt;
  return stream_metrics{std::string{end}, *rate_hz, *age_s};
}

/// The numbers that follow in `text`, if these are as many as wanted.
template <size_t Wanted>
std::optional<std::array<int64_t, Wanted>> counts_in(std::string_view text) {
  // The largest that JSON carries exactly.
  constexpr int64_t most = 9'007'199'254'740'991;
  std::array<int64_t, Wanted> result{};
  for (auto& value : result) {
    const auto word = take_until(text, ' ');
    const auto* end = word.data() + word.size();
    const auto [rest, error] = std::from_chars(word.data(), end, value);
    if (error != std::errc{} || rest != end || value < 0 || value > most)
      return std::nullopt;
  }
  return text.empty() ? std::optional{result} : std::nullopt;
}

/// "input:0 118 115 3 0 850", "output:0 115"
std::optional<stream_count> read_count(std::string_view text) {
  constexpr double us_in_ms = 1000;
  constexpr double most_ms = 1e9;
  stream_count result;
  result.end = take_until(text, ' ');
  if (!names_end(result.end))
    return std::nullopt;
  if (result.end[0] == 'o') {
    const auto written = counts_in<1>(text);
    if (!written)
      return std::nullopt;
    result.frames = written->front();
    return result;
  }
  const auto reported = counts_in<5>(text);
  if (!reported)
    return std::nullopt;
  result.frames = (*reported)[0];
  result.processed = (*reported)[1];
  result.failed = (*reported)[2];
  result.dropped = (*reported)[3];
  // A median of no frames is none.
  if (result.processed > 0)
    result.latency_ms =
        std::min(static_cast<double>((*reported)[4]) / us_in_ms, most_ms);
  return result;
}

/// All parts of a line, or none.
template <class T>
std::vector<T> read_all(std::string_view text,
                        std::optional<T> (*read)(std::string_view)) {
  std::vector<T> result;
  while (!text.empty()) {
    auto part = read(take_until(text, ';'));
    if (!part || result.size() == max_reported_streams)
      return {};
    result.push_back(std::move(*part));
  }
  return result;
}

} // namespace

std::vector<stream_metrics> read_streams(std::string_view text) {
  return read_all(text, read_stream);
}

std::vector<stream_count> read_frames(std::string_view text) {
  return read_all(text, read_count);
}

} // namespace roscell
