#include "actors/edge/dds/lives/participant_table.hpp"

namespace roscell {

void participant_table::told_by(std::uint8_t id, const guid_prefix& who) {
  // Who tells of itself needs nobody else.
  if (selves_.count(who) != 0)
    return;
  if (told_.size() < most || told_.count(who) != 0)
    told_[who] = {id, false};
}

void participant_table::told_itself(const guid_prefix& who) {
  told_.erase(who);
}

void participant_table::appeared(const guid_prefix& who) {
  if (told_.count(who) == 0 && selves_.size() < most)
    selves_.insert(who);
}

void participant_table::gone(const guid_prefix& who) {
  told_.erase(who);
  selves_.erase(who);
}

void participant_table::doubt(std::uint8_t id) {
  for (auto& [who, x] : told_)
    if (x.id == id)
      x.doubted = true;
}

std::vector<guid_prefix> participant_table::doubted(std::uint8_t id) const {
  std::vector<guid_prefix> result;
  for (const auto& [who, x] : told_)
    if (x.id == id && x.doubted)
      result.push_back(who);
  return result;
}

bool participant_table::was_told_by(std::uint8_t id,
                                    const guid_prefix& who) const {
  const auto known = told_.find(who);
  return known != told_.end() && known->second.id == id;
}

std::vector<guid_prefix> participant_table::told_by(std::uint8_t id) const {
  std::vector<guid_prefix> result;
  for (const auto& [who, x] : told_)
    if (x.id == id)
      result.push_back(who);
  return result;
}

} // namespace roscell
