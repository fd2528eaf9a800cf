#include "tools/roscell/ros2/topics_view.hpp"

#include "tools/roscell/view/format.hpp"
#include "tools/roscell/view/table.hpp"

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

std::string topics_view(const topic_list& topics, const view_style& style) {
  table t{{{"TOPIC"},
           {"TYPE", align::left, 1},
           {"WRITERS", align::left, 3},
           {"READERS", align::left, 2}},
          {}};
  std::string mismatches;
  for (const auto& x : topics.topics) {
    t.rows.push_back(
        {x.topic, x.data_type, ends_text(x.writers), ends_text(x.readers)});
    for (const auto& why : x.mismatches)
      mismatches += "\n" + printable(x.topic + ": " + why);
  }
  if (t.rows.empty())
    return "no topics\n";
  return t.render(style.text) + (mismatches.empty() ? "" : mismatches + "\n");
}

} // namespace roscell::cli
