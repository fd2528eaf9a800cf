#include "actors/instances/secrets/secret_table.hpp"

#include "actors/edge/disk/limits.hpp"

#include <utility>

namespace roscell {

bool secret_table::is_full() const {
  return set_at_.size() >= limits::secret::most;
}

void secret_table::keep(const std::string& name, int64_t unix_ms) {
  set_at_[name] = unix_ms;
}

void secret_table::forget(const std::string& name) {
  set_at_.erase(name);
}

void secret_table::give(const std::string& instance,
                        std::set<std::string> names) {
  given_[instance] = std::move(names);
}

void secret_table::take_back(const std::string& instance) {
  given_.erase(instance);
}

std::vector<std::string>
secret_table::holders_of(const std::string& name) const {
  std::vector<std::string> result;
  for (const auto& [instance, names] : given_)
    if (names.count(name) > 0)
      result.push_back(instance);
  return result;
}

secret_list secret_table::list() const {
  secret_list result;
  for (const auto& [name, unix_ms] : set_at_)
    result.secrets.push_back({name, unix_ms, holders_of(name)});
  return result;
}

std::vector<std::string> secret_table::names() const {
  std::vector<std::string> result;
  result.reserve(set_at_.size());
  for (const auto& [name, unix_ms] : set_at_)
    result.push_back(name);
  return result;
}

} // namespace roscell
