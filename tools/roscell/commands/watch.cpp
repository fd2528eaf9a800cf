#include "tools/roscell/commands/watch.hpp"

#include "tools/roscell/client/event_words.hpp"
#include "tools/roscell/exit_code.hpp"
#include "tools/roscell/view/terminal.hpp"

#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>
#include <utility>

namespace roscell::cli {

namespace {

/// Collects events on a thread of its own, so that many of them that arrive
/// while the screen is drawn are answered by one more drawing.
class change_signal {
public:
  explicit change_signal(const node_client& node)
      : node_{node}, reader_{[this] { read(); }} {}

  ~change_signal() {
    cancel_.cancel();
    reader_.join();
  }

  change_signal(const change_signal&) = delete;
  change_signal& operator=(const change_signal&) = delete;

  /// Waits for an event since the last call. Throws what ended the events.
  void wait() {
    std::unique_lock guard{mutex_};
    news_.wait(guard, [this] { return changed_ || ended_; });
    changed_ = false;
    if (ended_)
      std::rethrow_exception(ended_);
  }

private:
  void read() {
    try {
      node_.follow(
          "/v1/events?since=" + std::to_string(from_now_on),
          [this](std::string_view line) { return on_line(line); }, &cancel_);
      throw command_error{exit_unreachable, "the node has ended the stream"};
    } catch (...) {
      const std::lock_guard guard{mutex_};
      ended_ = std::current_exception();
      news_.notify_one();
    }
  }

  bool on_line(std::string_view line) {
    // The first line, a comment, says that nothing is missed from now on; what
    // happened since the first look is still to be seen.
    const bool opened = !std::exchange(open_, true);
    if (!events_.add_line(line) && !opened)
      return true;
    const std::lock_guard guard{mutex_};
    changed_ = true;
    news_.notify_one();
    return true;
  }

  const node_client& node_;
  http_cancel cancel_;
  event_stream events_; // Of the reader alone, as is the next.
  bool open_ = false;
  std::mutex mutex_;
  std::condition_variable news_;
  bool changed_ = false;
  std::exception_ptr ended_;
  std::thread reader_; // Last: it uses all the others.
};

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
