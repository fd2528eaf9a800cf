#include "actors/edge/engine/engine_log.hpp"

#include "schemas/utf8.hpp"

#include <algorithm>
#include <charconv>
#include <iterator>
#include <utility>

namespace roscell {

namespace {

constexpr size_t header_bytes = 8;

/// Takes `digits` decimal digits from the front of `text`.
bool take_number(std::string_view& text, size_t digits, int64_t& value) {
  const auto part = text.substr(0, digits);
  const auto* end = part.data() + part.size();
  const auto [rest, error] = std::from_chars(part.data(), end, value);
  if (error != std::errc{} || rest != end || part.size() != digits || value < 0)
    return false;
  text.remove_prefix(digits);
  return true;
}

bool take_char(std::string_view& text, char wanted) {
  if (text.empty() || text.front() != wanted)
    return false;
  text.remove_prefix(1);
  return true;
}

/// Days from 1970-01-01 in the Gregorian calendar, by H. Hinnant's
/// "days_from_civil" (chrono-compatible low-level date algorithms).
int64_t days_since_epoch(int64_t year, int64_t month, int64_t day) {
  if (month <= 2)
    --year;
  const auto era = year / 400;
  const auto year_of_era = year - era * 400;
  const auto day_of_year =
      (153 * (month + (month > 2 ? -3 : 9)) + 2) / 5 + day - 1;
  const auto day_of_era =
      year_of_era * 365 + year_of_era / 4 - year_of_era / 100 + day_of_year;
  return era * 146097 + day_of_era - 719468;
}

/// Ticks of ".457426139", which may have 1 to 9 digits or be left out.
bool take_fraction(std::string_view& text, int64_t& ticks) {
  ticks = 0;
  if (!take_char(text, '.'))
    return true;
  size_t digits = 0;
  for (; !text.empty() && text.front() >= '0' && text.front() <= '9';
       ++digits) {
    if (digits < 7)
      ticks = ticks * 10 + (text.front() - '0');
    text.remove_prefix(1);
  }
  for (auto i = digits; i < 7; ++i)
    ticks *= 10;
  return digits > 0 && digits <= 9;
}

/// Minutes east of Greenwich.
bool take_zone(std::string_view& text, int64_t& minutes) {
  minutes = 0;
  if (take_char(text, 'Z'))
    return true;
  const int64_t sign = take_char(text, '-') ? -1 : 1;
  int64_t hours = 0;
  int64_t rest = 0;
  if (sign > 0 && !take_char(text, '+'))
    return false;
  if (!take_number(text, 2, hours) || !take_char(text, ':')
      || !take_number(text, 2, rest))
    return false;
  minutes = sign * (hours * 60 + rest);
  return true;
}

} // namespace

std::optional<log_ticks> parse_log_time(std::string_view text) {
  int64_t year = 0;
  int64_t month = 0;
  int64_t day = 0;
  int64_t hour = 0;
  int64_t minute = 0;
  int64_t second = 0;
  int64_t fraction = 0;
  int64_t zone = 0;
  const bool good = take_number(text, 4, year) && take_char(text, '-')
                    && take_number(text, 2, month) && take_char(text, '-')
                    && take_number(text, 2, day) && take_char(text, 'T')
                    && take_number(text, 2, hour) && take_char(text, ':')
                    && take_number(text, 2, minute) && take_char(text, ':')
                    && take_number(text, 2, second)
                    && take_fraction(text, fraction) && take_zone(text, zone)
                    && text.empty();
  if (!good || month < 1 || month > 12 || day < 1 || day > 31)
    return std::nullopt;
  const auto minutes =
      (days_since_epoch(year, month, day) * 24 + hour) * 60 + minute - zone;
  return (minutes * 60 + second) * 1000 * log_ticks_per_ms + fraction;
}

void log_frames::add(std::string_view bytes) {
  rest_.erase(0, std::exchange(at_, 0));
  rest_ += bytes;
}

std::optional<std::string_view> log_frames::next() {
  const auto left = std::string_view{rest_}.substr(at_);
  if (broken_ || left.size() < header_bytes)
    return std::nullopt;
  size_t size = 0;
  for (size_t i = 4; i < header_bytes; ++i)
    size = size * 256 + static_cast<unsigned char>(left[i]);
  broken_ = left[0] < 0 || left[0] > 2
            || left.substr(1, 3) != std::string(3, '\0')
            || size > max_frame_bytes;
  if (broken_ || left.size() < header_bytes + size)
    return std::nullopt;
  at_ += header_bytes + size;
  return left.substr(header_bytes, size);
}

log_collector::log_collector(log_range range)
    : range_(range), next_offset_(range.from) {
  // nop
}

bool log_collector::take(std::string_view bytes) {
  frames_.add(bytes);
  while (const auto frame = frames_.next())
    if (!take_frame(*frame))
      return false;
  return !frames_.broken();
}

bool log_collector::take_frame(std::string_view frame) {
  const auto space = frame.find(' ');
  const auto time = parse_log_time(frame.substr(0, space));
  if (!time || space == std::string_view::npos)
    return true;
  const auto offset = std::max<int64_t>(0, *time - range_.origin);
  if (offset < range_.from)
    return true;
  const auto line = frame.substr(space + 1);
  const bool full = text_.size() + line.size() > range_.most_bytes
                    || static_cast<int64_t>(notes_.size()) >= range_.most_lines;
  if (!range_.last_part && !text_.empty() && full)
    return false;
  if (range_.times)
    notes_.push_back(
        {static_cast<int64_t>(text_.size()), *time / log_ticks_per_ms});
  text_ += line;
  next_offset_ = std::max(next_offset_, offset + 1);
  // Half as much again is kept, so that not every line moves the others.
  if (range_.last_part && text_.size() > 3 * range_.most_bytes / 2)
    forget_front(text_.size() - range_.most_bytes);
  return true;
}

/// The note of the line that is cut stays, for the rest of it.
void log_collector::forget_front(size_t bytes) {
  text_.erase(0, bytes);
  const auto cut = static_cast<int64_t>(bytes);
  for (auto& note : notes_)
    note.offset -= cut;
  const auto behind =
      std::find_if(notes_.begin(), notes_.end(),
                   [](const time_note& note) { return note.offset > 0; });
  if (behind != notes_.begin())
    notes_.erase(notes_.begin(), std::prev(behind));
}

log_part log_collector::part() const {
  log_part result;
  const auto cut =
      text_.size() > range_.most_bytes ? text_.size() - range_.most_bytes : 0;
  auto from = range_.last_part ? cut : 0;
  auto bytes = std::string_view{text_}.substr(from, range_.most_bytes);
  if (range_.times && range_.last_part) {
    const auto first = begin_of_last_lines(bytes, range_.most_lines);
    bytes.remove_prefix(first);
    from += first;
  }
  if (range_.times)
    result.times_unix_ms =
        line_times(bytes, static_cast<int64_t>(from), notes_);
  result.text = valid_utf8(bytes);
  if (result.text != bytes)
    result.bytes = to_base64(bytes);
  result.next_offset = next_offset_;
  return result;
}

} // namespace roscell
