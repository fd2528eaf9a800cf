#include "tools/roscell/top/follow/log_follower.hpp"

#include "actors/edge/http/http_target.hpp"

#include <utility>

namespace roscell::cli::top {

log_follower::log_follower(const http_endpoint& node, std::string instance,
                           mailbox& to)
    : node_{node}, instance_{std::move(instance)}, to_{to}, reader_{[this] {
        run();
      }} {}

log_follower::~log_follower() {
  node_.cancel();
  reader_.join();
}

void log_follower::run() {
  const auto path =
      "/v1/instances/" + percent_encode(instance_) + "/logs?tail=500&follow=1";
  try {
    node_.follow(path, [this](std::string_view x) {
      to_.put(log_line{std::string{x}});
      return true;
    });
    to_.put(log_line{"-- the instance has ended --"});
  } catch (const std::exception& e) {
    to_.put(log_line{"-- " + reason_in(e) + " --"});
  }
}

} // namespace roscell::cli::top
