#include "actors/instances/life/any_runtime.hpp"

#include "actors/core/answer_limits.hpp"
#include "actors/edge/process/fence_file.hpp"
#include "messages/event_kinds.hpp"
#include "messages/failure.hpp"

#include <algorithm>
#include <utility>

namespace roscell {

bool is_instance_id(const std::string& text) {
  const auto fits = [](unsigned char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z')
           || (c >= '0' && c <= '9') || c == '_' || c == '-' || c == '.';
  };
  constexpr size_t max_bytes = 200; // A file name may have 255.
  return !text.empty() && text.size() <= max_bytes && text[0] != '.'
         && std::all_of(text.begin(), text.end(), fits);
}

void keep_fence(const actor_context& context, const std::filesystem::path& file,
                const fence_container& request, bool& fails) {
  const auto why = move_fence(file, request.fence_boot_ms);
  const auto failed_before = std::exchange(fails, why.has_value());
  if (why && !failed_before)
    context.publish_event(events::fence_failed, request.instance,
                          {{"reason", why->message}, {"hint", why->hint}});
}

std::chrono::milliseconds wait_of(const log_query& query) {
  return std::chrono::milliseconds{
      std::clamp<int64_t>(query.wait_ms, 0, limits::log::wait.count())};
}

bool says_something(const log_excerpt& x) {
  return !x.text.empty() || x.ended;
}

caf::error no_log_of(const std::string& instance) {
  return fail(error_code::unknown_task,
              "there is no log of an instance '" + instance + "'", "/instance",
              "`roscell instances` lists them");
}

caf::error too_many_followers() {
  return fail(error_code::conflict, "too many follow the logs of this node", {},
              "ask without following");
}

} // namespace roscell
