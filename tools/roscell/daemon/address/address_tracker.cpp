#include "tools/roscell/daemon/address/address_tracker.hpp"

#include <algorithm>
#include <utility>

namespace roscell::cli {

using namespace std::chrono_literals;

address_tracker::address_tracker(interface_address at, bool fixed)
    : at_{std::move(at)}, fixed_{fixed}, unreliable_{!at_.carrier} {}

/// Its own address before all others of the interface, which may have got a
/// further one.
const interface_address*
address_tracker::find(const std::vector<interface_address>& all) const {
  const interface_address* result = nullptr;
  for (const auto& x : all) {
    if (x.address == at_.address && (fixed_ || x.name == at_.name))
      return &x;
    if (!result && !fixed_ && x.name == at_.name)
      result = &x;
  }
  return result;
}

void address_tracker::observe(const std::vector<interface_address>& all,
                              time_point now) {
  const auto* found = find(all);
  const bool is_here = found && found->address == at_.address;
  if (!is_here && !gone_since_)
    gone_since_ = now;
  if (is_here && gone_since_) {
    unreliable_ = unreliable_ || now - *gone_since_ >= tolerated_gap;
    gone_since_.reset();
  }
  const bool replaces = found && found->carrier && (!is_here || unreliable_);
  const auto successor = replaces ? found->address : std::string{};
  if (std::exchange(successor_, successor) != successor)
    successor_since_ = now;
}

address_tracker::time_point address_tracker::settled_at() const {
  const bool first_carrier = !at_.carrier && successor_ == at_.address;
  return successor_since_ + (first_carrier ? 0ms : settling);
}

address_action address_tracker::action(time_point now) const {
  if (!successor_.empty() && now >= settled_at())
    return address_action::renew;
  if (fixed_ && gone_since_ && now - *gone_since_ >= patience)
    return address_action::give_up;
  return address_action::stay;
}

std::optional<address_tracker::time_point> address_tracker::due() const {
  if (!successor_.empty())
    return settled_at();
  if (fixed_ && gone_since_)
    return *gone_since_ + patience;
  return std::nullopt;
}

} // namespace roscell::cli
