#include "tools/roscell/top/follow/asker.hpp"

#include <algorithm>
#include <utility>

namespace roscell::cli::top {

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

} // namespace roscell::cli::top
