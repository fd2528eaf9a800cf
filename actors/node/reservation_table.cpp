#include "actors/node/reservation_table.hpp"

#include "actors/instances/limits.hpp"
#include "actors/node/limits.hpp"

namespace roscell {

std::optional<std::string> reservation_table::keep(const instance_spec& spec,
                                                   time_point now) {
  forget_outdated(now);
  if (reservations_.size() >= limits::instance::most
      && reservations_.count(spec.instance) == 0)
    return "it keeps room for " + std::to_string(limits::instance::most)
           + " instances already";
  reservations_[spec.instance] = {spec,
                                  now + limits::task::longest_reservation};
  return std::nullopt;
}

void reservation_table::give_up(const std::string& task,
                                const std::string& instance) {
  for (auto i = reservations_.begin(); i != reservations_.end();)
    if (i->second.spec.task == task
        && (instance.empty() || i->first == instance))
      i = reservations_.erase(i);
    else
      ++i;
}

std::vector<instance_spec>
reservation_table::open(time_point now, const std::set<std::string>& known) {
  forget_outdated(now);
  std::vector<instance_spec> result;
  for (const auto& [instance, x] : reservations_)
    if (known.count(instance) == 0)
      result.push_back(x.spec);
  return result;
}

void reservation_table::forget_outdated(time_point now) {
  for (auto i = reservations_.begin(); i != reservations_.end();)
    i = i->second.until <= now ? reservations_.erase(i) : std::next(i);
}

} // namespace roscell
