#include "actors/edge/history/history_folder.hpp"

#include "actors/edge/io/node_time.hpp"

#include <algorithm>
#include <system_error>
#include <utility>
#include <variant>

namespace roscell {

namespace fs = std::filesystem;

namespace {

/// For this user alone; returns it.
const fs::path& made(const fs::path& folder) {
  std::error_code error;
  if (fs::create_directories(folder, error))
    fs::permissions(folder, fs::perms::owner_all, error);
  return folder;
}

int64_t wall_now_ms() {
  return node_time_ms() + wall_clock_ahead_ms();
}

/// When something is too old. A wall clock that is set wrong for a while must
/// not cost a week of history, so the node's own time has to agree.
int64_t agreed_now_ms() {
  return std::min(node_time_ms(), wall_now_ms());
}

} // namespace

history_folder::history_folder(const fs::path& folder, history_bound bound)
    : bound_(bound), events_(made(folder)), numbers_(folder / "numbers"),
      logs_(folder / "logs"),
      first_number_(std::max(numbers_.before(), events_.highest())),
      last_number_(first_number_) {
  std::lock_guard<std::mutex> lock{mutex_};
  logs_.look();
  // Where this fails the first batch tries it again, and says why.
  numbers_.set_aside(first_number_);
  drop_old(agreed_now_ms());
  drop_down_to(bound_.bytes);
}

edge_result<events_written> history_folder::write(const event_batch& batch) {
  std::lock_guard<std::mutex> lock{mutex_};
  auto problem = events_.append(batch.events, wall_now_ms());
  if (problem && bytes() > 0) {
    drop_down_to(bytes() / 2);
    problem = events_.append(batch.events, wall_now_ms());
  }
  if (problem)
    return *problem;
  if (!batch.events.empty())
    last_number_ = batch.events.back().sequence;
  problem = batch.last ? numbers_.finish(last_number_)
                       : numbers_.set_aside(last_number_);
  if (problem)
    return *problem;
  drop_old(agreed_now_ms());
  drop_down_to(bound_.bytes);
  return events_written{numbers_.end()};
}

std::vector<event> history_folder::read(const past_events_query& query) const {
  std::lock_guard<std::mutex> lock{mutex_};
  return events_.read(query);
}

void history_folder::hold_bound() {
  std::lock_guard<std::mutex> lock{mutex_};
  // A runtime puts its logs there itself.
  logs_.look();
  drop_old(agreed_now_ms());
  drop_down_to(bound_.bytes);
}

bool history_folder::make_room() {
  std::lock_guard<std::mutex> lock{mutex_};
  const auto before = bytes();
  drop_down_to(before / 2);
  return bytes() < before;
}

uint64_t history_folder::bytes() const {
  return events_.bytes() + logs_.bytes();
}

bool history_folder::drop_oldest() {
  const auto event = events_.oldest_unix_ms();
  const auto log = logs_.oldest_unix_ms();
  if (log && (!event || *log <= *event))
    return logs_.drop_oldest();
  return event && events_.drop_oldest();
}

void history_folder::drop_down_to(uint64_t bytes) {
  while (this->bytes() > bytes && drop_oldest()) {
  }
}

void history_folder::drop_old(int64_t now_unix_ms) {
  const auto oldest_kept = now_unix_ms - bound_.age.count();
  for (;;) {
    const auto event = events_.oldest_unix_ms();
    const auto log = logs_.oldest_unix_ms();
    const bool is_old =
        (event && *event < oldest_kept) || (log && *log < oldest_kept);
    if (!is_old || !drop_oldest())
      return;
  }
}

} // namespace roscell
