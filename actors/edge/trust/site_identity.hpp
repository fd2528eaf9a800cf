#pragma once

#include "actors/edge/trust/handshake_thread.hpp"
#include "actors/edge/trust/identity_file.hpp"
#include "actors/edge/trust/tls_settings.hpp"

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

namespace roscell {

/// What one is at his site, and whom he believes there, as it is now: his
/// certificate may be renewed, and the list of the revoked grow. Its file is
/// looked at before each handshake, so a longer one counts from the moment at
/// which it is there. From any thread.
class site_identity {
public:
  /// @param revoked_file signed by the site; it need not be there.
  site_identity(own_identity own, std::filesystem::path revoked_file);

  /// That of a file of PEM, with the list of the revoked beside it, in a file
  /// of its name and ".revoked". Errors: those of `read_identity_file`.
  static edge_result<std::shared_ptr<site_identity>>
  in_file(const std::filesystem::path& file);

  /// The same for as long as this lives.
  const identity& who() const noexcept {
    return who_;
  }

  /// SHA-256 of the site's certificate, in hexadecimal.
  const std::string& site_digest() const noexcept {
    return site_digest_;
  }

  own_identity own() const;
  int64_t ends_unix_s() const;

  /// Nobody believes it now: it is to be renewed.
  bool has_ended() const;

  /// For a connection of his.
  tls_settings settings() const;

  /// Whom he believes at this moment.
  trust_now trust() const;

  /// From now on he shows this, which is of the same one at the same site.
  void renew(own_identity own);

  /// Nobody of that list is believed any more, and connections of theirs end.
  /// False: it is not newer than the one that is known.
  bool take_revoked(revocation_list list);

  /// Calls once, on any thread and maybe at once, when that certificate is
  /// revoked, unless `unwatch` is called before.
  uint64_t watch(const certificate& of, std::function<void()> on_revoked);
  void unwatch(uint64_t ticket);

  /// Until when somebody without an identity may come for one.
  void expect_newcomers(std::chrono::steady_clock::time_point until);
  bool expects_newcomers() const;

  /// Where his handshakes are computed.
  handshake_thread& handshakes() const noexcept {
    return handshakes_;
  }

private:
  struct watcher {
    certificate of;
    std::function<void()> on_revoked;
  };

  tls_settings settings_of(const own_identity& own);
  bool look_at_revoked();
  void notify_watchers();

  const identity who_;
  const std::string site_digest_;
  const std::filesystem::path revoked_file_;
  mutable std::mutex mutex_; // Guards what follows.
  own_identity own_;
  std::shared_ptr<const revocation_list> revoked_;
  std::filesystem::file_time_type seen_{};
  std::map<uint64_t, watcher> watchers_;
  uint64_t last_ticket_ = 0;
  std::chrono::steady_clock::time_point newcomers_until_{};
  /// After all that its jobs use.
  std::optional<tls_settings> settings_;
  mutable handshake_thread handshakes_;
};

} // namespace roscell
