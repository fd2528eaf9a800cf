#include "tools/roscell/client/find_logs.hpp"

#include "tools/roscell/exit_code.hpp"
#include "tools/roscell/view/format.hpp"

#include <algorithm>
#include <set>

namespace roscell::cli {

namespace {

/// The first of each key among those that are meant.
template <class Predicate, class Key>
std::vector<kept_log> first_of_each(const std::vector<kept_log>& known,
                                    Predicate&& is_meant, Key&& key) {
  std::vector<kept_log> result;
  std::set<std::string> seen;
  for (const auto& log : known)
    if (is_meant(log) && seen.insert(key(log)).second)
      result.push_back(log);
  return result;
}

} // namespace

std::vector<kept_log> find_kept_logs(const std::vector<kept_log>& known,
                                     const std::string& word) {
  const auto by_instance = [](const kept_log& x) { return x.instance; };
  const auto by_step = [](const kept_log& x) { return x.step; };
  auto found = first_of_each(
      known, [&](const kept_log& x) { return x.instance == word; },
      by_instance);
  if (!found.empty() || word.empty())
    return found;
  found = first_of_each(
      known, [&](const kept_log& x) { return x.task == word; }, by_step);
  std::sort(
      found.begin(), found.end(),
      [](const kept_log& x, const kept_log& y) { return x.step < y.step; });
  if (!found.empty())
    return found;
  found = first_of_each(
      known,
      [&](const kept_log& x) {
        return x.instance.compare(0, word.size(), word) == 0;
      },
      by_instance);
  if (found.size() < 2)
    return found;
  std::vector<std::string> ids;
  ids.reserve(found.size());
  for (const auto& x : found)
    ids.push_back(x.instance);
  throw command_error{exit_usage,
                      "several kept logs are of instances that begin with '"
                          + word + "'",
                      joined(ids, ", ")};
}

std::string kept_log_text(const kept_log& log, int64_t now_unix_ms) {
  auto result = printable(log.instance) + " on node " + printable(log.node)
                + ": " + std::string{to_string(log.state)};
  if (log.ended_unix_ms > 0)
    result += ' ' + format_since(log.ended_unix_ms, now_unix_ms) + " ago";
  if (log.exit_code >= 0)
    result += ", exit code " + std::to_string(log.exit_code);
  return log.reason.empty() ? result
                            : result + " (" + printable(log.reason) + ")";
}

} // namespace roscell::cli
