#include "tools/roscell/client/progress.hpp"

#include "tools/roscell/view/terminal.hpp"

#include <future>
#include <utility>

namespace roscell::cli {

namespace {

/// What takes longer than this is told about.
constexpr std::chrono::seconds silent_at_first{1};

} // namespace

progress::progress(const node_client& node, event_line_function lines)
    : lines_{std::move(lines)}, events_{lines_of(node),
                                        {[](auto&&) {},
                                         [this](const event& e) {
                                           for (const auto& x : lines_(e))
                                             print_line(x);
                                         },
                                         // The request itself meets the same
                                         // problem and tells of it.
                                         [](auto&&) { return false; }}} {}

void progress::begin() {
  const std::lock_guard guard{mutex_};
  begun_ = true;
  for (const auto& line : held_)
    print_note(line);
  held_.clear();
}

void progress::print_line(const std::string& line) {
  const std::lock_guard guard{mutex_};
  if (begun_)
    print_note(line);
  else
    held_.push_back(line);
}

json post_with_progress(const node_client& node, const std::string& body,
                        std::chrono::milliseconds limit,
                        event_line_function lines) {
  progress reporter{node, std::move(lines)};
  auto reply = std::async(std::launch::async, [&] {
    return node.post("/v1/requests", body, limit);
  });
  if (reply.wait_for(silent_at_first) == std::future_status::timeout) {
    print_note("waiting for " + node.where().text() + " ...");
    reporter.begin();
  }
  return reply.get();
}

} // namespace roscell::cli
