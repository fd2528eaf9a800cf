#include "actors/edge/dds/lives/participant_table.hpp"

#include <algorithm>

namespace roscell {

void participant_table::reported_by(std::uint8_t id, const guid_prefix& who) {
  // Who tells of itself needs nobody else.
  if (selves_.count(who) != 0)
    return;
  if (reported_.size() < most || reported_.count(who) != 0)
    reported_[who] = {id, false};
}

void participant_table::reported_itself(const guid_prefix& who) {
  reported_.erase(who);
}

void participant_table::appeared(const guid_prefix& who) {
  if (reported_.count(who) == 0 && selves_.size() < most)
    selves_.insert(who);
}

void participant_table::gone(const guid_prefix& who) {
  reported_.erase(who);
  selves_.erase(who);
}

void participant_table::doubt(std::uint8_t id) {
  for (auto& [who, x] : reported_)
    if (x.id == id)
      x.doubted = true;
}

std::vector<guid_prefix> participant_table::doubted(std::uint8_t id) const {
  std::vector<guid_prefix> result;
  for (const auto& [who, x] : reported_)
    if (x.id == id && x.doubted)
      result.push_back(who);
  return result;
}

bool participant_table::was_reported_by(std::uint8_t id,
                                        const guid_prefix& who) const {
  const auto known = reported_.find(who);
  return known != reported_.end() && known->second.id == id;
}

std::vector<guid_prefix> participant_table::reported_by(std::uint8_t id) const {
  std::vector<guid_prefix> result;
  for (const auto& [who, x] : reported_)
    if (x.id == id)
      result.push_back(who);
  return result;
}

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
