#include "tools/roscell/shell/follower.hpp"

#include "messages/failure.hpp"
#include "messages/node.hpp"
#include "tools/roscell/client/event_text.hpp"
#include "tools/roscell/exit_code.hpp"
#include "tools/roscell/shell/quick_question.hpp"
#include "tools/roscell/view/format.hpp"
#include "tools/roscell/view/terminal.hpp"

#include <sys/eventfd.h>

#include <algorithm>
#include <utility>

namespace roscell::cli {

namespace {

using std::chrono::milliseconds;

constexpr milliseconds first_pause{250};
constexpr milliseconds longest_pause{5000};
constexpr milliseconds node_answer_limit{3000};
constexpr milliseconds longest_first_wait{1000};

/// More lines than this wait for nobody, while a long command runs.
constexpr size_t most_waiting_lines = 500;

/// Whether the node may have come into another cell, or out of one.
bool changes_status(const event& e) {
  return e.what.rfind("cell_", 0) == 0 || e.what.rfind("coordinator_", 0) == 0;
}

} // namespace

follower::follower(const node_client& node)
    : node_{node}, news_{eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)},
      pause_{first_pause} {
  if (!news_)
    throw command_error{exit_refused, "too many open files"};
  thread_ = std::thread{[this] { run(); }};
}

follower::~follower() {
  {
    const std::lock_guard guard{mutex_};
    ends_ = true;
  }
  changed_.notify_all();
  cancel_.cancel();
  thread_.join();
}

void follower::await_first_answer() {
  std::unique_lock guard{mutex_};
  changed_.wait_for(guard, longest_first_wait, [this] { return answered_; });
}

node_connection_status follower::status() const {
  const std::lock_guard guard{mutex_};
  return status_;
}

std::vector<std::string> follower::take_lines() {
  eventfd_t ignored = 0;
  eventfd_read(news_.get(), &ignored);
  const std::lock_guard guard{mutex_};
  auto result = std::exchange(lines_, {});
  if (const auto count = std::exchange(left_out_, 0); count != 0)
    result.insert(result.begin(),
                  "(" + std::to_string(count) + " lines are left out)");
  return result;
}

void follower::show(std::optional<event_filter> filter) {
  const std::lock_guard guard{mutex_};
  filter_ = std::move(filter);
}

std::set<std::string> follower::kinds() const {
  const std::lock_guard guard{mutex_};
  return kinds_;
}

void follower::refresh_now() {
  const std::lock_guard guard{mutex_};
  hurries_ = !status_.is_reachable;
  changed_.notify_all();
}

void follower::run() {
  while (true) {
    try {
      follow_once();
    } catch (const command_error& e) {
      report_lost_contact(e.what());
    } catch (const refused& e) {
      report_lost_contact(failure_from(e.reply).message);
    } catch (const std::exception& e) {
      report_lost_contact(std::string{"the answer is not of this version: "}
                          + e.what());
    }
    pause();
    const std::lock_guard guard{mutex_};
    if (ends_)
      return;
  }
}

void follower::follow_once() {
  const auto since = begin_of_events();
  event_stream events;
  bool is_open = false;
  node_.follow(
      "/v1/events?since=" + std::to_string(since),
      [&](std::string_view line) {
        // The first line, a comment, says that nothing is missed from now on.
        if (!std::exchange(is_open, true))
          on_open();
        if (const auto complete = events.add_line(line))
          on_event(*complete);
        return true;
      },
      &cancel_);
  throw command_error{exit_unreachable, "it has ended the stream"};
}

json follower::ask_for_node() {
  return ask_quickly(node_, {"/v1/node", ""}, node_answer_limit, &cancel_);
}

/// The number after which events are new. A node that was lost and is the same
/// tells what was missed; one that was started again has counted from 1.
uint64_t follower::begin_of_events() {
  const auto started = ask_for_node().at("started_unix_ms").get<int64_t>();
  const auto before = std::exchange(started_unix_ms_, started);
  if (before != 0 && before != started)
    last_ = 0;
  return last_;
}

void follower::on_open() {
  const auto node = ask_for_node().get<node_description>();
  const std::lock_guard guard{mutex_};
  const bool is_back = answered_ && !status_.is_reachable;
  status_ = {node.identity.name, node.cell, true};
  answered_ = true;
  pause_ = first_pause;
  if (is_back)
    add_line("roscell: " + printable(node.identity.name) + " is back");
  eventfd_write(news_.get(), 1);
  changed_.notify_all();
}

void follower::on_event(const event& e) {
  last_ = e.sequence;
  if (changes_status(e))
    on_open();
  const std::lock_guard guard{mutex_};
  kinds_.insert(e.what);
  if (!filter_ || !filter_->takes(e))
    return;
  add_line(shortened_line(event_line(e, stdout_style().width)));
  eventfd_write(news_.get(), 1);
}

/// Said once, and not again while it is looked for.
void follower::report_lost_contact(const std::string& why) {
  const std::lock_guard guard{mutex_};
  const bool is_known = answered_ && !status_.is_reachable;
  answered_ = true;
  status_.is_reachable = false;
  if (ends_ || is_known)
    return;
  const auto who = status_.node.empty() ? node_.where().text() : status_.node;
  add_line("roscell: " + printable(who + " is lost: " + why)
           + "; it is looked for again");
  eventfd_write(news_.get(), 1);
  changed_.notify_all();
}

void follower::pause() {
  std::unique_lock guard{mutex_};
  changed_.wait_for(guard, pause_, [this] { return ends_ || hurries_; });
  hurries_ = false;
  pause_ = std::min(pause_ * 2, longest_pause);
}

/// With the lock held.
void follower::add_line(std::string line) {
  if (lines_.size() == most_waiting_lines) {
    lines_.erase(lines_.begin());
    ++left_out_;
  }
  lines_.push_back(std::move(line));
}

} // namespace roscell::cli
