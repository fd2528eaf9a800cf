#include "actors/edge/trust/site_identity.hpp"

#include "actors/edge/disk/small_file.hpp"
#include "actors/edge/trust/limits.hpp"

#include <chrono>
#include <system_error>
#include <utility>

namespace roscell {

site_identity::site_identity(own_identity own,
                             std::filesystem::path revoked_file)
    : own_(std::move(own)), site_digest_(own_.site.digest()),
      revoked_file_(std::move(revoked_file)) {
  // The settings are this object's own, and no handshake outlives it.
  settings_.emplace(own_, [this] { return trust(); });
}

edge_result<std::shared_ptr<site_identity>>
site_identity::in_file(const std::filesystem::path& file) {
  auto read = read_identity_file(file);
  if (auto* why = std::get_if<edge_error>(&read))
    return *why;
  auto beside = file;
  beside += ".revoked";
  return std::make_shared<site_identity>(
      std::get<own_identity>(std::move(read)), std::move(beside));
}

/// A file that has gone, or that the site has not signed, takes nothing back,
/// nor does one of a lower number.
void site_identity::look_at_revoked() const {
  std::error_code problem;
  const auto written = std::filesystem::last_write_time(revoked_file_, problem);
  if (problem || written == seen_)
    return;
  seen_ = written;
  const auto text =
      read_small_file(revoked_file_, limits::trust::revocations_bytes);
  auto list = revocation_list::read(text.value_or(""), own_.site);
  if (list && (!revoked_ || list->number() > revoked_->number()))
    revoked_ = std::make_shared<const revocation_list>(std::move(*list));
}

trust_now site_identity::trust() const {
  const auto clock = std::chrono::duration_cast<std::chrono::seconds>(
      std::chrono::system_clock::now().time_since_epoch());
  const std::lock_guard guard{mutex_};
  look_at_revoked();
  return {{own_.site, revoked_},
          trusted_now(clock.count(), 0, own_.chain.front().begins_unix_s())};
}

} // namespace roscell
