#pragma once

namespace roscell::cli::top {

/// While it lives, a crash of this process puts the terminal back as it was
/// when this was made, before it ends the process as it would have anyway. To
/// be made before a screen is opened, which tells it how that is left.
class crash_guard {
public:
  crash_guard();
  ~crash_guard();

  crash_guard(const crash_guard&) = delete;
  crash_guard& operator=(const crash_guard&) = delete;

  /// What terminals of this kind are told at the end of a full screen, as the
  /// terminal database has it.
  static void remember_farewell(const char* text);
};

} // namespace roscell::cli::top
