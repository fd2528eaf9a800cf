#include "actors/instances/process/process_limits.hpp"

#include "messages/event_kinds.hpp"

#include <filesystem>
#include <set>
#include <system_error>

namespace roscell {

void drop_cgroup(const process_runtime_config& config,
                 const std::string& instance, const instance_cgroup& cgroup) {
  if (!cgroup.remove())
    config.context.publish_event(
        events::cgroup_left, instance,
        {{"folder", cgroup.folders().front().string()}});
}

instance_cgroup cgroup_of(const process_runtime_config& config,
                          const std::string& instance) {
  const auto noted = instance_cgroup::recall(config.instances_dir / instance);
  return noted.folders().empty()
             ? instance_cgroup::named(config.cgroups, instance)
             : noted;
}

instance_bounds bounds_of(const start_container& request) {
  const auto& policy = request.scheduling.policy;
  return {request.limits.memory_mib, request.limits.cpu,
          policy == "fifo" || policy == "rr"};
}

void clear_cgroups(const process_runtime_config& config) {
  std::set<std::string> known;
  std::error_code error;
  for (std::filesystem::directory_iterator i{config.instances_dir, error}, end;
       !error && i != end; i.increment(error))
    known.insert(i->path().filename().native());
  for (const auto& x : remove_other_cgroups(config.cgroups, known))
    config.context.publish_event(events::cgroup_left, x);
}

} // namespace roscell
