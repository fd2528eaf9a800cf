#include "client/columns.hpp"
#include "client/value_text.hpp"

#include <map>

namespace roscell {

namespace {

/// "camera_1 (best_effort), / x2 (reliable, transient_local)". Volatile is what
/// most are, and is not said.
std::string ends_text(const std::vector<topic_end>& ends) {
  std::map<std::string, int> counts;
  for (const auto& x : ends) {
    auto word = (x.program.empty() ? "?" : x.program) + " (" + x.reliability;
    if (x.durability != "volatile")
      word += ", " + x.durability;
    ++counts[word + ")"];
  }
  std::vector<std::string> words;
  words.reserve(counts.size());
  for (const auto& [word, count] : counts)
    words.push_back(count == 1 ? word : word + " x" + std::to_string(count));
  return joined(words, ", ");
}

} // namespace

const column_list<topic_row>& topic_columns() {
  using row = const topic_row&;
  using now = int64_t;
  static const column_list<topic_row> result{
      {{"TOPIC"},
       [](row x, now) -> column_value { return x.topic; },
       "key",
       "/topic"},
      {{"TYPE", align::left, 1},
       [](row x, now) -> column_value { return x.data_type; },
       "text",
       "/data_type"},
      {{"WRITERS", align::left, 2},
       [](row x, now) -> column_value { return ends_text(x.writers); },
       "programs",
       "/writers"},
      {{"READERS", align::left, 1},
       [](row x, now) -> column_value { return ends_text(x.readers); },
       "programs",
       "/readers"},
      {{"MISMATCHES", align::left, only_wide, false, true},
       [](row x, now) -> column_value { return joined(x.mismatches, "; "); },
       "problems",
       "/mismatches"},
  };
  return result;
}

} // namespace roscell
