#include "tools/roscell/tasks/task_history.hpp"

#include "messages/task.hpp"
#include "tools/roscell/view/event_text.hpp"
#include "tools/roscell/view/format.hpp"
#include "tools/roscell/view/terminal.hpp"

#include <chrono>

namespace roscell::cli {

namespace {

/// A coordinator answers at once.
constexpr std::chrono::seconds history_limit{10};

} // namespace

void print_history(const node_client& node, const std::string& task,
                   bool as_json) {
  const auto reply =
      node.ask(message_json(task_history_query{task}), history_limit);
  if (as_json) {
    print(pretty(reply));
    return;
  }
  const auto history = reply.get<task_history>();
  const auto width = stdout_style().width;
  std::string text = event_heading(width) + "\n";
  uint64_t before = 0;
  for (const auto& e : history.events) {
    if (e.sequence > before + 1)
      text += "... " + std::to_string(e.sequence - before - 1)
              + " more, which are not kept\n";
    before = e.sequence;
    text += shortened_line(event_line(e, width)) + "\n";
  }
  print(text);
}

} // namespace roscell::cli
