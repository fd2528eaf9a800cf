#include "tools/roscell/top/follow/log_follower.hpp"

#include "actors/edge/http/http_target.hpp"

#include <utility>

namespace roscell::cli::top {

log_follower::log_follower(const node_client& node, std::string instance,
                           mailbox& to, line_taker take)
    : node_{node}, instance_{std::move(instance)}, to_{to},
      take_{std::move(take)}, reader_{[this] { run(); }} {}

log_follower::~log_follower() {
  cancel_.cancel();
  reader_.join();
}

void log_follower::put(const std::string& line) {
  to_.put([take = take_, line] { take(line); });
}

void log_follower::run() {
  const auto path =
      "/v1/instances/" + percent_encode(instance_) + "/logs?tail=500&follow=1";
  try {
    const auto on_line = [this](std::string_view x) {
      put(std::string{x});
      return true;
    };
    node_.follow(path, on_line, &cancel_);
    put("-- the instance has ended --");
  } catch (const std::exception&) {
    put("-- " + reason_in(std::current_exception()) + " --");
  }
}

} // namespace roscell::cli::top
