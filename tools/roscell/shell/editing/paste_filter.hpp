#pragma once

#include <string>
#include <string_view>

namespace roscell::cli {

/// Takes the marks out of what a terminal sends that says what is pasted
/// (bracketed paste), and makes blanks of tabs there, so that pasted text is
/// never completed.
class paste_filter {
public:
  /// What is to be read of these bytes. The beginning of a mark is kept until
  /// the rest has come, Escape too: it begins the keys of an editor, and means
  /// nothing to it before the next one.
  std::string add(std::string_view bytes);

private:
  std::string kept_;
  bool pasting_ = false;
};

} // namespace roscell::cli
