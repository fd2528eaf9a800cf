#pragma once

#include "actors/edge/trust/certificate_making.hpp"

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>

namespace roscell {

/// The certificates of a site that count no more, as a list with a number: of
/// two lists the one with the higher number counts. A certificate is named by
/// its serial, or with all that its owner had at that time by his UUID, since
/// coordinators renew what the site has made. The site has signed it, so it may
/// come from anybody. A value.
class revocation_list {
public:
  /// Number 0, nobody.
  explicit revocation_list(std::string site);

  const std::string& site() const noexcept {
    return site_;
  }

  int64_t number() const noexcept {
    return number_;
  }

  /// Serials, and when each certificate would have ended.
  const std::map<std::string, int64_t>& serials() const noexcept {
    return serials_;
  }

  /// UUIDs, and up to when what they had counts no more.
  const std::map<std::string, int64_t>& owners() const noexcept {
    return owners_;
  }

  bool contains(const std::string& serial) const {
    return serials_.count(serial) > 0;
  }

  /// Whether it counts no more.
  bool revokes(const certificate& x) const;
  bool revokes(const std::string& serial, const std::string& uuid,
               int64_t begins_unix_s) const;

  /// Adds one, under the next number. What cannot even be renewed any more is
  /// left out. False: the list is full.
  bool add(const std::string& serial, int64_t ends_unix_s, int64_t now_unix_s);

  /// The same for all that he has now.
  bool add_owner(const std::string& uuid, int64_t now_unix_s);

  /// As it is passed on.
  std::string signed_text(const private_key& site_key) const;

  /// None for what is no such list of that site, or was not signed by it. The
  /// reader of outside bytes; at most `limits::trust::revocations_bytes`.
  static std::optional<revocation_list> read(std::string_view text,
                                             const certificate& site);

private:
  std::string text() const;
  bool take_line(std::string_view line);
  bool make_room(int64_t now_unix_s);

  std::string site_;
  int64_t number_ = 0;
  std::map<std::string, int64_t> serials_;
  std::map<std::string, int64_t> owners_;
};

} // namespace roscell
