#include "actors/edge/process/notification.hpp"

#include "actors/edge/io/plain_text.hpp"
#include "actors/edge/process/reported_streams.hpp"
#include "schemas/utf8.hpp"

#include <algorithm>
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

void read_line(std::string_view line, notification& result) {
  constexpr std::string_view status = "STATUS=";
  constexpr std::string_view streams = "ROSCELL_STREAMS=";
  constexpr std::string_view frames = "ROSCELL_FRAMES=";
  constexpr std::string_view remark = "ROSCELL_REMARK=";
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
  else if (line.substr(0, status.size()) == status)
    result.status = bounded_text(line.substr(status.size()), max_status_bytes);
  else if (line.substr(0, streams.size()) == streams)
    result.streams = read_streams(line.substr(streams.size()));
  else if (line.substr(0, frames.size()) == frames)
    result.frames = read_frames(line.substr(frames.size()));
  else if (line.substr(0, remark.size()) == remark)
    result.remark = bounded_text(line.substr(remark.size()), max_remark_bytes);
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
}

} // namespace roscell
