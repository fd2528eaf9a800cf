#include "tools/roscell/client/watch.hpp"

#include "tools/roscell/exit_code.hpp"
#include "tools/roscell/view/terminal.hpp"

#include <string>
#include <utility>

namespace roscell::cli {

// What happened since the first look is still to be seen once the events flow.
change_signal::change_signal(const node_client& node)
    : events_{
        lines_of(node),
        {[this](auto&&) { note(); }, [this](auto&&) { note(); },
         [this](const std::exception_ptr& why) {
           note(why ? why
                    : std::make_exception_ptr(command_error{
                        exit_unreachable, "the node has ended the stream"}));
           return false;
         }}} {}

bool change_signal::wait_until(time_point limit) {
  std::unique_lock guard{mutex_};
  const auto has_news = [this] { return changed_ || ended_ != nullptr; };
  // Not every clock can be waited for to its end.
  const bool result = limit == time_point::max()
                          ? (news_.wait(guard, has_news), true)
                          : news_.wait_until(guard, limit, has_news);
  changed_ = false;
  if (ended_)
    std::rethrow_exception(ended_);
  return result;
}

void change_signal::note(const std::exception_ptr& end) {
  const std::lock_guard guard{mutex_};
  changed_ = true;
  ended_ = end;
  news_.notify_one();
}

namespace {

/// The drawing of one document.
class screen {
public:
  screen(bool as_json, const std::function<std::string(const json&)>& view)
      : as_json_{as_json}, view_{view} {}

  void show(const json& document) {
    auto text = as_json_ ? compact(document) : view_(document);
    if (text == last_)
      return;
    last_ = std::move(text);
    // Home and clear below: unlike a cleared screen this does not flicker.
    const bool redrawn = !as_json_ && stdout_is_terminal();
    print((redrawn ? "\x1b[H\x1b[J" : "") + last_);
    if (!as_json_ && !redrawn)
      print("\n");
  }

private:
  bool as_json_;
  const std::function<std::string(const json&)>& view_;
  std::string last_;
};

} // namespace

int watch(const node_client& node, bool as_json,
          const std::function<json()>& fetch,
          const std::function<std::string(const json&)>& view) {
  end_quietly_on_interrupt();
  change_signal changes{node};
  screen output{as_json, view};
  while (true) {
    output.show(fetch());
    changes.wait();
  }
}

} // namespace roscell::cli
