#include "actors/node/history/kept_log_reading.hpp"

#include "actors/edge/process/instance_log.hpp"
#include "messages/failure.hpp"

#include <optional>
#include <utility>

namespace roscell {

caf::result<log_excerpt> read_kept_log(const history_folder& history,
                                       const log_query& query) {
  const auto log = history.with_logs(
      [&](const auto& logs) { return logs.newest_of(query.instance); });
  if (!log)
    return fail(error_code::unknown_task,
                "no log of an instance '" + query.instance + "' is kept",
                "/instance",
                "`roscell instances` lists those that are there, `roscell logs "
                "--previous` the logs of those that are gone");
  const auto lines =
      query.tail_lines > 0 ? query.tail_lines : instance_log::default_lines;
  auto part = query.offset < 0 ? log->read_tail(lines, query.times)
                               : log->read_from(query.offset, query.times);
  return log_excerpt{
      query.instance, std::move(part.text),          part.next_offset,
      part.ended,     std::move(part.times_unix_ms), std::move(part.bytes)};
}

kept_logs list_kept_logs(const history_folder& history,
                         const kept_logs_query& query) {
  return history.with_logs([&](const auto& logs) { return logs.list(query); });
}

} // namespace roscell
