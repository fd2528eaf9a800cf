#include "embedding/skills/frame_hub.hpp"

#include <algorithm>
#include <utility>

namespace roscell::embedding {

void frame_hub::subscribe(const std::string& stream,
                          const std::shared_ptr<frame_inbox>& inbox,
                          std::size_t port) {
  std::lock_guard<std::mutex> lock{mutex_};
  // Readers come and go; what nobody reads any more is forgotten here.
  for (auto i = readers_.begin(); i != readers_.end();) {
    auto& all = i->second;
    all.erase(std::remove_if(all.begin(), all.end(),
                             [](const reader& x) { return x.inbox.expired(); }),
              all.end());
    i = all.empty() ? readers_.erase(i) : std::next(i);
  }
  readers_[stream].push_back({inbox, port});
}

void frame_hub::publish(const std::string& stream, const shared_frame& x) {
  std::vector<std::pair<std::shared_ptr<frame_inbox>, std::size_t>> to;
  {
    std::lock_guard<std::mutex> lock{mutex_};
    const auto i = readers_.find(stream);
    if (i == readers_.end())
      return;
    for (const auto& each : i->second)
      if (auto inbox = each.inbox.lock())
        to.emplace_back(std::move(inbox), each.port);
  }
  for (const auto& [inbox, port] : to)
    inbox->push(port, x, engine::when_full::drop_oldest);
}

} // namespace roscell::embedding
