#pragma once

#include "actors/edge/trust/handshake_thread.hpp"
#include "actors/edge/trust/identity_file.hpp"
#include "actors/edge/trust/tls_settings.hpp"

#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

namespace roscell {

/// What one is at his site, and whom he believes there, as it is now: the list
/// of the revoked is looked at before each handshake, so a longer one counts
/// from the moment at which its file is there. From any thread.
class site_identity {
public:
  /// @param revoked_file signed by the site; it need not be there.
  site_identity(own_identity own, std::filesystem::path revoked_file);

  /// That of a file of PEM, with the list of the revoked beside it, in a file
  /// of its name and ".revoked". Errors: those of `read_identity_file`.
  static edge_result<std::shared_ptr<site_identity>>
  in_file(const std::filesystem::path& file);

  const identity& who() const noexcept {
    return own_.who();
  }

  /// SHA-256 of the site's certificate, in hexadecimal.
  const std::string& site_digest() const noexcept {
    return site_digest_;
  }

  int64_t ends_unix_s() const {
    return own_.chain.front().ends_unix_s();
  }

  /// For a connection of his.
  const tls_settings& settings() const noexcept {
    return *settings_;
  }

  /// Whom he believes at this moment.
  trust_now trust() const;

  /// Where his handshakes are computed.
  handshake_thread& handshakes() const noexcept {
    return handshakes_;
  }

private:
  void look_at_revoked() const;

  const own_identity own_;
  const std::string site_digest_;
  const std::filesystem::path revoked_file_;
  mutable std::mutex mutex_; // Guards what follows.
  mutable std::shared_ptr<const revocation_list> revoked_;
  mutable std::filesystem::file_time_type seen_{};
  /// After all that its jobs use.
  std::optional<tls_settings> settings_;
  mutable handshake_thread handshakes_;
};

} // namespace roscell
