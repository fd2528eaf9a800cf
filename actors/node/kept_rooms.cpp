#include "actors/node/kept_rooms.hpp"

#include "actors/house/limits.hpp"

namespace roscell {

std::optional<std::string> kept_rooms::keep(const instance_spec& spec,
                                            time_point now) {
  forget_outdated(now);
  if (rooms_.size() >= limits::instance::most
      && rooms_.count(spec.instance) == 0)
    return "it keeps room for " + std::to_string(limits::instance::most)
           + " instances already";
  rooms_[spec.instance] = {spec, now + limits::task::longest_reservation};
  return std::nullopt;
}

void kept_rooms::give_up(const std::string& task, const std::string& instance) {
  for (auto i = rooms_.begin(); i != rooms_.end();)
    if (i->second.spec.task == task
        && (instance.empty() || i->first == instance))
      i = rooms_.erase(i);
    else
      ++i;
}

std::vector<instance_spec>
kept_rooms::open(time_point now, const std::set<std::string>& known) {
  forget_outdated(now);
  std::vector<instance_spec> result;
  for (const auto& [instance, x] : rooms_)
    if (known.count(instance) == 0)
      result.push_back(x.spec);
  return result;
}

void kept_rooms::forget_outdated(time_point now) {
  for (auto i = rooms_.begin(); i != rooms_.end();)
    i = i->second.until <= now ? rooms_.erase(i) : std::next(i);
}

} // namespace roscell
