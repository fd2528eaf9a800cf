#include "actors/edge/process/notification.hpp"
#include "schemas/utf8.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string_view>

namespace {

bool is_sound(const roscell::stream_metrics& x) {
  return (x.end.rfind("input:", 0) == 0 || x.end.rfind("output:", 0) == 0)
         && x.end.size() <= 9 && std::isfinite(x.rate_hz) && x.rate_hz >= 0
         && std::isfinite(x.age_s) && x.age_s >= -1;
}

bool is_sound(const roscell::stream_count& x) {
  return (x.end.rfind("input:", 0) == 0 || x.end.rfind("output:", 0) == 0)
         && x.end.size() <= 9 && x.frames >= 0 && x.failed >= 0
         && x.dropped >= 0 && x.latency_ms >= -1 && x.latency_ms <= 1e9;
}

} // namespace

/// Whatever a program says, its status is one short line of valid UTF-8, and
/// metrics of its streams are few and finite.
extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, size_t size) {
  using namespace roscell;
  const std::string_view bytes{reinterpret_cast<const char*>(data), size};
  const auto words = parse_notification(bytes);
  if (words.status.size() > max_status_bytes
      || words.status.find('\n') != std::string::npos
      || valid_utf8(words.status) != words.status
      || unfinished_utf8(words.status) != 0)
    std::abort();
  const auto sound = [](const auto& x) { return is_sound(x); };
  if (words.streams.size() > max_reported_streams
      || !std::all_of(words.streams.begin(), words.streams.end(), sound)
      || words.frames.size() > max_reported_streams
      || !std::all_of(words.frames.begin(), words.frames.end(), sound)
      || words.remark.size() > max_remark_bytes)
    std::abort();
  const auto text = valid_utf8(bytes);
  if (valid_utf8(text) != text || unfinished_utf8(bytes) > 3)
    std::abort();
  return 0;
}
