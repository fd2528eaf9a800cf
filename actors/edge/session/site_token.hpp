#pragma once

#include "actors/edge/io/edge_error.hpp"

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

namespace roscell {

class site_identity;

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

  /// One who has an identity, and no token: connections prove who is who. What
  /// else is proved has a text that all of the site know, and that is worth
  /// something inside of such connections only.
  static site_secret of_identity(std::shared_ptr<site_identity> identity);

  /// Null: the token proves who is of the site.
  const std::shared_ptr<site_identity>& identity() const;

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
  std::shared_ptr<site_identity> identity_;
};

// The file of the site token that all nodes of one user on one host share,
// whatever their data directories. Lengths: `limits::token`.

/// Names the file where it is to be elsewhere.
constexpr const char* site_token_variable = "ROSCELL_SITE_TOKEN";

/// Where it is: what the variable says; else /etc/roscell/site.token for root,
/// and roscell/site.token in the folder of settings of anybody else. Empty: he
/// has no such folder.
std::filesystem::path own_site_token();

/// Makes it with a fresh token, unless it is there; of two that do so at once
/// both find the same one then. Only its owner can read it, and its folder
/// unless that was there. Blocks on the disk. Why it cannot, if so.
std::optional<edge_error> make_site_token(const std::filesystem::path& file);

/// The token in that file. Errors: schema_violation (not there, not readable,
/// too short or too long), unauthorized (others than its user and root may
/// change it).
edge_result<std::string> read_site_token(const std::filesystem::path& file);

/// What to do where there is none: `at` is the address of a node that has it,
/// if one is known.
std::string site_token_hint(const std::filesystem::path& file,
                            const std::string& at = {});

} // namespace roscell
