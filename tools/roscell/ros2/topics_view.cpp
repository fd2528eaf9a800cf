#include "tools/roscell/ros2/topics_view.hpp"

#include "tools/roscell/view/columns.hpp"
#include "tools/roscell/view/format.hpp"

#include <algorithm>
#include <map>

namespace roscell::cli {

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
  using how = const view_style&;
  static const column_list<topic_row> result{
      {{"TOPIC"}, [](row x, how) -> cell { return x.topic; }, "key", "/topic"},
      {{"TYPE", align::left, 1},
       [](row x, how) -> cell { return x.data_type; },
       "text",
       "/data_type"},
      {{"WRITERS", align::left, 2},
       [](row x, how) -> cell { return ends_text(x.writers); },
       "programs",
       "/writers"},
      {{"READERS", align::left, 1},
       [](row x, how) -> cell { return ends_text(x.readers); },
       "programs",
       "/readers"},
      {{"MISMATCHES", align::left, only_wide, false, true},
       [](row x, how) -> cell { return joined(x.mismatches, "; "); },
       "problems",
       "/mismatches"},
  };
  return result;
}

std::string topics_view(const topic_list& topics, const view_style& style) {
  std::string mismatches;
  for (const auto& x : topics.topics)
    for (const auto& why : x.mismatches)
      mismatches += "\n" + printable(x.topic + ": " + why);
  if (topics.topics.empty())
    return "no topics\n";
  return table_of(topic_columns(), topics.topics, style).render(style.text)
         + (mismatches.empty() ? "" : mismatches + "\n");
}

} // namespace roscell::cli
