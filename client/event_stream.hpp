#pragma once

#include "messages/event.hpp"

#include <optional>
#include <string>
#include <string_view>

namespace roscell {

/// Puts the lines of a text/event-stream together to events. Unknown fields,
/// comments, and data that is no event are skipped, so that a newer node can
/// say more than this program knows.
class event_stream {
public:
  /// Takes one line without its end. Returns the event that it completes.
  std::optional<event> add_line(std::string_view line);

private:
  std::string data_;
};

} // namespace roscell
