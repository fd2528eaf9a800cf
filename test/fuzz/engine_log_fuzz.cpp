#include "actors/edge/engine/engine_log.hpp"
#include "actors/edge/io/plain_text.hpp"
#include "actors/edge/limits.hpp"
#include "schemas/utf8.hpp"

#include <algorithm>
#include <cstdlib>
#include <string_view>

/// Whatever an engine sends as a log, a part of it is bounded valid UTF-8, and
/// it does not matter how the bytes were cut on their way.
extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, size_t size) {
  using namespace roscell;
  const std::string_view bytes{reinterpret_cast<const char*>(data), size};
  for (const bool last_part : {false, true}) {
    const log_range range{0, 0, last_part, true};
    log_collector whole{range};
    const bool more = whole.take(bytes);
    log_collector pieces{range};
    bool more_pieces = true;
    for (size_t at = 0; at < size && more_pieces; at += 7)
      more_pieces = pieces.take(bytes.substr(at, 7));
    const auto part = whole.part();
    // Replacements are three times as long as what they replace.
    if (part.text.size() > 3 * limits::log::part_bytes
        || valid_utf8(part.text) != part.text || part.next_offset < 0
        || (size > 0 && more != more_pieces) || part.text != pieces.part().text
        || part.next_offset != pieces.part().next_offset)
      std::abort();
  }
  parse_log_time(bytes);
  line_splitter lines{64, [](std::string_view line) {
                        return line.find('\n') == std::string_view::npos;
                      }};
  if (!lines.take(bytes))
    std::abort();
  return 0;
}
