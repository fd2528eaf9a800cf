#pragma once

#include <filesystem>
#include <memory>
#include <string>

namespace roscell {

/// The token that proves nodes of one site to each other, as it is now: its
/// file is looked at each time, so a node learns of a token that is made,
/// copied or changed later without being started again. Copies share what they
/// know. From any thread.
class site_secret {
public:
  /// None, and there never will be.
  site_secret();

  /// A text that stays as it is; for tests.
  site_secret(std::string text);
  site_secret(const char* text);

  static site_secret in_file(std::filesystem::path file);

  /// Where it is; empty: in no file.
  const std::filesystem::path& file() const;

  /// Empty: there is none that may be used, and nobody is to be trusted.
  std::string text() const;

  /// Why there is none, and what to do about it. Empty: there is one.
  struct lack {
    std::string message;
    std::string hint;
  };
  lack what_lacks() const;

private:
  class keeper;
  explicit site_secret(std::shared_ptr<keeper> x);

  std::shared_ptr<keeper> keeper_;
};

} // namespace roscell
