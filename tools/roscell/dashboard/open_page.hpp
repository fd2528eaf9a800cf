#pragma once

#include <filesystem>
#include <string>

namespace roscell::cli {

/// The desktop's browser at an address that has a secret. It is led there by a
/// file that only this user reads, and that is there as long as this lives: all
/// users see the arguments of processes.
class opened_page {
public:
  explicit opened_page(const std::string& url);
  ~opened_page();

  opened_page(const opened_page&) = delete;
  opened_page& operator=(const opened_page&) = delete;

  /// Whether there was something to be started. It may fail yet.
  bool has_begun() const {
    return begun_;
  }

private:
  std::filesystem::path signpost_; ///< Empty: there is none.
  bool begun_ = false;
};

} // namespace roscell::cli
