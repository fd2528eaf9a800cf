#include "tools/roscell/top/follow/asker.hpp"

#include "actors/edge/http/http_target.hpp"
#include "tools/roscell/exit_code.hpp"

#include <sys/eventfd.h>
#include <unistd.h>

#include <algorithm>
#include <utility>

namespace roscell::cli::top {

mailbox::mailbox() : fd_{eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)} {
  if (fd_ < 0)
    throw command_error{exit_refused, "too many open files"};
}

mailbox::~mailbox() {
  close(fd_);
}

void mailbox::put(work x) {
  const std::lock_guard guard{mutex_};
  waiting_.push_back(std::move(x));
  eventfd_write(fd_, 1);
}

void mailbox::work_off() {
  std::vector<work> due;
  {
    const std::lock_guard guard{mutex_};
    eventfd_t count = 0;
    eventfd_read(fd_, &count);
    due = std::exchange(waiting_, {});
  }
  for (const auto& x : due)
    x();
}

namespace {

using std::chrono::steady_clock;

constexpr std::chrono::milliseconds shortest_pause{250};

/// A coordinator waits for its members for less.
constexpr std::chrono::seconds longest_answer{10};

/// A node spends so small a part of its time on the answers.
constexpr int part_of_time = 20;

} // namespace

asker::asker(const node_client& node, cell_model& model, mailbox& to)
    : node_{node}, model_{model}, to_{to}, worker_{[this] { run(); }} {}

asker::~asker() {
  {
    const std::lock_guard guard{mutex_};
    ended_ = true;
  }
  wakes_.notify_one();
  cancel_.cancel();
  worker_.join();
}

void asker::ask(const questions& what) {
  if (!what.any())
    return;
  const std::lock_guard guard{mutex_};
  wanted_.add(what);
  wakes_.notify_one();
}

bool asker::wait_for_questions(questions& due) {
  std::unique_lock guard{mutex_};
  wakes_.wait(guard, [this] { return ended_ || wanted_.any(); });
  wakes_.wait_until(guard, earliest_, [this] { return ended_; });
  due = std::exchange(wanted_, {});
  return !ended_;
}

void asker::run() {
  for (questions due; wait_for_questions(due);) {
    const auto begun = steady_clock::now();
    try {
      answer(due);
    } catch (const std::exception&) {
      to_.put([this, why = reason_in(std::current_exception())] {
        model_.miss(why);
      });
    }
    const auto ended = steady_clock::now();
    earliest_ = ended
                + std::max<steady_clock::duration>(
                    shortest_pause, part_of_time * (ended - begun));
  }
}

void asker::answer(const questions& due) {
  if (due.cell)
    ask_for_cell();
  if (due.skills)
    to_.put([this, x = get("/v1/skills").get<skill_list>()] {
      model_.set_skills(x);
    });
  if (due.metrics)
    to_.put([this, x = get("/v1/instances").get<instance_description>()] {
      model_.set_metrics(x.instances);
    });
}

json asker::get(const std::string& path) const {
  return node_.get(path, {longest_answer, &cancel_});
}

void asker::ask_for_cell() {
  const auto asked = get("/v1/node").get<node_description>();
  const auto cell = asked.role == node_role::coordinator
                        ? get("/v1/cell?resources=now").get<cell_description>()
                        : cell_around(asked);
  to_.put([this, asked, cell] { model_.set_cell(asked, cell); });
}

log_follower::log_follower(const node_client& node, std::string instance,
                           mailbox& to, line_taker take)
    : node_{node}, instance_{std::move(instance)}, to_{to},
      take_{std::move(take)}, reader_{[this] { run(); }} {}

log_follower::~log_follower() {
  cancel_.cancel();
  reader_.join();
}

void log_follower::put(const std::string& line) {
  to_.put([take = take_, line] { take(line); });
}

void log_follower::run() {
  const auto path =
      "/v1/instances/" + percent_encode(instance_) + "/logs?tail=500&follow=1";
  try {
    const auto on_line = [this](std::string_view x) {
      put(std::string{x});
      return true;
    };
    node_.follow(path, on_line, &cancel_);
    put("-- the instance has ended --");
  } catch (const std::exception&) {
    put("-- " + reason_in(std::current_exception()) + " --");
  }
}

} // namespace roscell::cli::top
