#include "tools/roscell/shell/follower.hpp"

#include "messages/node.hpp"
#include "tools/roscell/exit_code.hpp"
#include "tools/roscell/view/event_text.hpp"
#include "tools/roscell/view/format.hpp"
#include "tools/roscell/view/terminal.hpp"

#include <sys/eventfd.h>

#include <algorithm>
#include <utility>

namespace roscell::cli {

namespace {

using std::chrono::milliseconds;

constexpr milliseconds node_answer_limit{3000};
constexpr milliseconds longest_first_wait{1000};

/// More lines than this wait for nobody, while a long command runs.
constexpr size_t most_waiting_lines = 500;

/// Whether the node may have come into another cell, or out of one.
bool changes_status(const event& e) {
  return e.what.rfind("cell_", 0) == 0 || e.what.rfind("coordinator_", 0) == 0;
}

unique_fd open_news() {
  unique_fd result{eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)};
  if (!result)
    throw command_error{exit_refused, "too many open files"};
  return result;
}

} // namespace

// Of a node that was lost and is back what was missed is shown, too.
follower::follower(const node_client& node)
    : node_{node}, news_{open_news()},
      events_{lines_of(node),
              {[this](const auto& missed) {
                 ask_for_node();
                 for (const auto& e : missed)
                   on_event(e);
               },
               [this](const event& e) { on_event(e); },
               [this](const auto& why) { return report_lost_contact(why); }}} {}

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
  if (!status().is_reachable)
    events_.look_now();
}

void follower::ask_for_node() {
  const auto node =
      node_.get("/v1/node", {node_answer_limit, &events_.cancel()})
          .get<node_description>();
  const std::lock_guard guard{mutex_};
  const bool is_back = answered_ && !status_.is_reachable;
  status_ = {node.identity.name, node.cell, true};
  answered_ = true;
  if (is_back)
    add_line("roscell: " + printable(node.identity.name) + " is back");
  eventfd_write(news_.get(), 1);
  changed_.notify_all();
}

void follower::on_event(const event& e) {
  if (changes_status(e))
    ask_for_node();
  const std::lock_guard guard{mutex_};
  kinds_.insert(e.what);
  if (!filter_ || !filter_->takes(e))
    return;
  add_line(shortened_line(event_line(e, stdout_style().width)));
  eventfd_write(news_.get(), 1);
}

/// Said once, and not again while it is looked for.
bool follower::report_lost_contact(const std::exception_ptr& why) {
  const std::lock_guard guard{mutex_};
  const bool is_known = answered_ && !status_.is_reachable;
  answered_ = true;
  status_.is_reachable = false;
  if (is_known)
    return true;
  const auto who = status_.node.empty() ? node_.where().text() : status_.node;
  add_line("roscell: " + printable(who + " is lost: " + reason_in(why))
           + "; it is looked for again");
  eventfd_write(news_.get(), 1);
  changed_.notify_all();
  return true;
}

/// With the lock held.
void follower::add_line(std::string line) {
  if (lines_.size() == most_waiting_lines) {
    lines_.erase(lines_.begin());
    ++left_out_;
  }
  lines_.push_back(std::move(line));
}

namespace {

bool is_of_kind(const event& e, const std::string& kind) {
  return !kind.empty() && kind.back() == '*'
             ? e.what.compare(0, kind.size() - 1, kind, 0, kind.size() - 1) == 0
             : e.what == kind;
}

bool is_about(const event& e, const std::string& subject) {
  return e.subject == subject || event_text(e, "task") == subject
         || event_text(e, "node") == subject
         || event_text(e, "step") == subject;
}

} // namespace

bool event_filter::takes(const event& e) const {
  const auto fits = [&e](const auto& wanted, auto matches) {
    return wanted.empty()
           || std::any_of(wanted.begin(), wanted.end(),
                          [&](const auto& x) { return matches(e, x); });
  };
  return fits(kinds, is_of_kind) && fits(subjects, is_about);
}

std::string event_filter::text() const {
  auto result = kinds.empty() ? "all events" : joined(kinds, ", ");
  if (!subjects.empty())
    result += " of " + joined(subjects, ", ");
  return result;
}

} // namespace roscell::cli
