#include "actors/edge/http/handshake_queue.hpp"

#include <algorithm>
#include <utility>

namespace roscell {

bool handshake_queue::has_place(const std::string& address) const {
  const auto here = of_.find(address);
  return begun_.size() < places_
         && (here == of_.end() || here->second < places_of_one_);
}

handshake_queue::ticket handshake_queue::enter(std::string address,
                                               std::function<void()> begin) {
  const auto number = ++last_;
  waiting_.push_back({number, std::move(address), std::move(begin)});
  serve();
  return number;
}

void handshake_queue::leave(ticket whose) {
  const auto begun = begun_.find(whose);
  if (begun == begun_.end()) {
    const auto is_his = [&](const candidate& x) { return x.number == whose; };
    waiting_.erase(std::remove_if(waiting_.begin(), waiting_.end(), is_his),
                   waiting_.end());
    return;
  }
  const auto here = of_.find(begun->second);
  if (--here->second == 0)
    of_.erase(here);
  begun_.erase(begun);
  serve();
}

/// Who begins may leave at once, and others come.
void handshake_queue::serve() {
  for (;;) {
    const auto next =
        std::find_if(waiting_.begin(), waiting_.end(),
                     [&](const candidate& x) { return has_place(x.address); });
    if (next == waiting_.end())
      return;
    const auto chosen = std::move(*next);
    waiting_.erase(next);
    begun_.emplace(chosen.number, chosen.address);
    ++of_[chosen.address];
    chosen.begin();
  }
}

} // namespace roscell
