#pragma once

#include "actors/edge/disk/data_folder.hpp"
#include "actors/edge/trust/identity_place.hpp"
#include "actors/edge/trust/revocations.hpp"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace roscell {

/// A certificate that a site has made, without what only its owner has.
struct issued_certificate {
  identity who;
  std::string serial;
  int64_t begins_unix_s = 0;
  int64_t ends_unix_s = 0;
};

/// A site on the disk of whoever looks after it: its key and certificate, the
/// certificates that were made, and the list of the revoked. For its user
/// alone, who holds a lock on it as long as this lives. Blocks on the disk.
class site_folder {
public:
  /// Makes a site. Errors: conflict (there is one), schema_violation (it cannot
  /// be called so), internal.
  static edge_result<site_folder> create(const std::filesystem::path& folder,
                                         const std::string& site,
                                         int64_t now_unix_s);

  /// Errors: schema_violation (there is none, or a file of it is damaged),
  /// unauthorized (others may change it), conflict (another command is at it).
  static edge_result<site_folder> open(const std::filesystem::path& folder);

  const certificate& site() const noexcept {
    return site_;
  }

  const revocation_list& revoked() const noexcept {
    return revoked_;
  }

  const std::vector<issued_certificate>& issued() const noexcept {
    return issued_;
  }

  /// Makes an identity, and writes down that there is one before it is given
  /// away. A coordinator gets one to make those of nodes by, too. Errors:
  /// internal (the disk).
  edge_result<kept_identity> issue(const identity& who, int64_t now_unix_s,
                                   int64_t good_for_s);

  /// Makes the certificate of one who has made that key himself.
  edge_result<certificate> certify(const identity& who, EVP_PKEY* key,
                                   int64_t now_unix_s, int64_t good_for_s);

  /// Revokes that certificate. Errors: conflict (it is revoked, the list is
  /// full), internal (the disk).
  std::optional<edge_error> revoke(const issued_certificate& x,
                                   int64_t now_unix_s);

  /// Revokes all that whoever has that UUID has now. Errors: conflict (the list
  /// is full), internal (the disk).
  std::optional<edge_error> revoke_owner(const std::string& uuid,
                                         int64_t now_unix_s);

  /// Whether it counts no more.
  bool is_revoked(const issued_certificate& x) const {
    return revoked_.revokes(x.serial, x.who.uuid, x.begins_unix_s);
  }

  /// The list as it is passed on.
  std::string signed_list() const {
    return revoked_.signed_text(key_);
  }

private:
  site_folder(std::filesystem::path folder, directory_lock lock,
              private_key key, certificate site);

  edge_result<site_folder> loaded() &&;
  edge_result<own_identity> make(const identity& who, int64_t now_unix_s,
                                 int64_t good_for_s);
  std::optional<edge_error> take_list(revocation_list longer, bool has_room);
  std::optional<edge_error> write(const char* name, const std::string& text);

  std::filesystem::path folder_;
  directory_lock lock_;
  private_key key_;
  certificate site_;
  revocation_list revoked_;
  std::vector<issued_certificate> issued_;
};

} // namespace roscell
