#include "tools/roscell/client/find_instances.hpp"

#include "schemas/closest_word.hpp"
#include "tools/roscell/exit_code.hpp"
#include "tools/roscell/view/format.hpp"

#include <algorithm>
#include <iterator>
#include <string_view>

namespace roscell::cli {

namespace {

template <class Predicate>
std::vector<instance_row> those(const std::vector<instance_row>& known,
                                Predicate&& is_meant) {
  std::vector<instance_row> result;
  std::copy_if(known.begin(), known.end(), std::back_inserter(result),
               is_meant);
  return result;
}

[[noreturn]] void refuse_unknown(const std::vector<instance_row>& known,
                                 const std::string& word) {
  std::vector<std::string_view> names;
  for (const auto& row : known) {
    names.push_back(row.spec.instance);
    names.push_back(row.spec.task);
  }
  const std::string near{closest_word(word, names)};
  throw command_error{exit_refused,
                      "no instance and no task '" + word + "' is known",
                      (near.empty() ? "" : "did you mean '" + near + "'? ")
                          + std::string{"`roscell instances` lists them"}};
}

} // namespace

std::vector<instance_row> find_instances(const std::vector<instance_row>& known,
                                         const std::string& word) {
  auto found =
      those(known, [&](const auto& row) { return row.spec.instance == word; });
  if (found.empty())
    found =
        those(known, [&](const auto& row) { return row.spec.task == word; });
  if (!found.empty())
    return found;
  found = those(known, [&](const auto& row) {
    return row.spec.instance.compare(0, word.size(), word) == 0;
  });
  if (found.empty() || word.empty())
    refuse_unknown(known, word);
  if (found.size() == 1)
    return found;
  std::vector<std::string> ids;
  ids.reserve(found.size());
  for (const auto& row : found)
    ids.push_back(row.spec.instance);
  throw command_error{exit_usage, "several instances begin with '" + word + "'",
                      joined(ids, ", ")};
}

} // namespace roscell::cli
