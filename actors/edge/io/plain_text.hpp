#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>

namespace roscell {

/// Cuts a stream of bytes into lines, without their line feeds.
class line_splitter {
public:
  /// Returns whether it wants more.
  using receiver = std::function<bool(std::string_view line)>;

  line_splitter(size_t max_line_bytes, receiver on_line);

  /// False if the receiver has enough.
  bool take(std::string_view bytes);

  /// The last line may have no line feed.
  void finish();

  /// Whether the rest that is kept exceeds the longest line.
  bool too_long() const {
    return rest_.size() > max_line_bytes_;
  }

private:
  bool pass(std::string_view line);

  size_t max_line_bytes_;
  receiver on_line_;
  std::string rest_;
};

// What unauthenticated peers may call themselves: it ends up in replies and
// logs.

/// Whether the byte is an ASCII control character.
bool is_control(char c);

/// Whether the text can name a node or a cell: as `name` in
/// schemas/common.schema.json.
bool is_name(std::string_view text);

/// Whether the text can be a node's UUID: as `uuid` there.
bool is_uuid(std::string_view text);

/// Takes the text before the next `mark`, or all of it, off the front, and the
/// mark with it.
std::string_view take_until(std::string_view& text, char mark);

} // namespace roscell
