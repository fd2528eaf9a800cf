#include "actors/edge/dds/lives/speaker_lives.hpp"

#include <algorithm>

namespace roscell {

std::int64_t speaker_lives::hear(const guid_prefix& who, time_point now) {
  auto i = speakers_.find(who);
  if (i == speakers_.end()) {
    make_room();
    i = speakers_.emplace(who, speaker{now, 0}).first;
  }
  auto& x = i->second;
  if (now - x.heard >= silence)
    ++x.returns;
  x.heard = now;
  return x.returns * numbers_a_life;
}

void speaker_lives::make_room() {
  if (speakers_.size() >= most)
    speakers_.erase(std::min_element(speakers_.begin(), speakers_.end(),
                                     [](const auto& x, const auto& y) {
                                       return x.second.heard < y.second.heard;
                                     }));
}

} // namespace roscell
