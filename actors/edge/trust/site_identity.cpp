#include "actors/edge/trust/site_identity.hpp"

#include "actors/edge/disk/small_file.hpp"
#include "actors/edge/trust/identity_place.hpp"
#include "actors/edge/trust/limits.hpp"

#include <chrono>
#include <system_error>
#include <utility>
#include <vector>

namespace roscell {

site_identity::site_identity(own_identity own,
                             std::filesystem::path revoked_file)
    : who_(own.who()), site_digest_(own.site.digest()),
      revoked_file_(std::move(revoked_file)), own_(std::move(own)) {
  look_at_revoked();
  settings_ = settings_of(own_);
}

edge_result<std::shared_ptr<site_identity>>
site_identity::in_file(const std::filesystem::path& file) {
  auto read = read_identity_file(file);
  if (auto* why = std::get_if<edge_error>(&read))
    return *why;
  return std::make_shared<site_identity>(
      std::get<own_identity>(std::move(read)), revoked_file_of(file));
}

/// The settings are this object's own, and no handshake outlives it.
tls_settings site_identity::settings_of(const own_identity& own) {
  return {own, [this] {
            if (look_at_revoked())
              notify_watchers();
            return trust();
          }};
}

own_identity site_identity::own() const {
  const std::lock_guard guard{mutex_};
  return own_;
}

int64_t site_identity::ends_unix_s() const {
  const std::lock_guard guard{mutex_};
  return own_.chain.front().ends_unix_s();
}

tls_settings site_identity::settings() const {
  const std::lock_guard guard{mutex_};
  return *settings_;
}

trust_now site_identity::trust() const {
  const auto clock = std::chrono::duration_cast<std::chrono::seconds>(
      std::chrono::system_clock::now().time_since_epoch());
  const std::lock_guard guard{mutex_};
  return {{own_.site, revoked_},
          trusted_now(clock.count(), 0, own_.chain.front().begins_unix_s())};
}

void site_identity::renew(own_identity own) {
  auto made = settings_of(own);
  const std::lock_guard guard{mutex_};
  own_ = std::move(own);
  settings_ = std::move(made);
}

bool site_identity::has_ended() const {
  return trust().unix_s > ends_unix_s();
}

/// A file that has gone, or that the site has not signed, takes nothing back,
/// nor does one of a lower number. True: it is a longer one.
bool site_identity::look_at_revoked() {
  const std::lock_guard guard{mutex_};
  std::error_code problem;
  const auto written = std::filesystem::last_write_time(revoked_file_, problem);
  if (problem || written == seen_)
    return false;
  seen_ = written;
  const auto text =
      read_small_file(revoked_file_, limits::trust::revocations_bytes);
  auto list = revocation_list::read(text.value_or(""), own_.site);
  if (!list || (revoked_ && list->number() <= revoked_->number()))
    return false;
  revoked_ = std::make_shared<const revocation_list>(std::move(*list));
  return true;
}

bool site_identity::take_revoked(revocation_list list) {
  {
    const std::lock_guard guard{mutex_};
    if (revoked_ && list.number() <= revoked_->number())
      return false;
    revoked_ = std::make_shared<const revocation_list>(std::move(list));
  }
  notify_watchers();
  return true;
}

uint64_t site_identity::watch(const certificate& of,
                              std::function<void()> on_revoked) {
  uint64_t result = 0;
  {
    const std::lock_guard guard{mutex_};
    result = ++last_ticket_;
    // The list may have grown between its handshake and this.
    if (!revoked_ || !revoked_->revokes(of)) {
      watchers_.emplace(result, watcher{of, std::move(on_revoked)});
      return result;
    }
  }
  on_revoked();
  return result;
}

void site_identity::expect_newcomers(
    std::chrono::steady_clock::time_point until) {
  const std::lock_guard guard{mutex_};
  newcomers_until_ = until;
}

bool site_identity::expects_newcomers() const {
  const std::lock_guard guard{mutex_};
  return std::chrono::steady_clock::now() < newcomers_until_;
}

void site_identity::unwatch(uint64_t ticket) {
  const std::lock_guard guard{mutex_};
  watchers_.erase(ticket);
}

void site_identity::notify_watchers() {
  std::vector<std::function<void()>> due;
  {
    const std::lock_guard guard{mutex_};
    for (auto i = watchers_.begin(); revoked_ && i != watchers_.end();)
      if (revoked_->revokes(i->second.of)) {
        due.push_back(std::move(i->second.on_revoked));
        i = watchers_.erase(i);
      } else {
        ++i;
      }
  }
  for (const auto& call : due)
    call();
}

} // namespace roscell
