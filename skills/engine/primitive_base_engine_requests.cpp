#include "skills/engine/primitive_base_engine.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

/// What a node asks of an engine that runs: it is done between two frames.
namespace roscell::engine {

namespace {

/// A node reads no more of a reason.
constexpr std::size_t most_refusal_bytes = 512;

/// With its name and number it has to be a datagram that a node reads.
constexpr std::size_t most_request_bytes = 3500;

} // namespace

void primitive_base_engine::want_safety() {
  safety_wanted_ = true;
  queue_.interpose([this] { between_frames(); });
}

void primitive_base_engine::use_variables(changed_variables reported) {
  {
    const std::lock_guard guard{reported_mutex_};
    reported_ = std::move(reported);
  }
  queue_.interpose([this] { between_frames(); });
}

void primitive_base_engine::use_parameters(ordered_parameters wanted) {
  {
    const std::lock_guard guard{reported_mutex_};
    wanted_ = std::move(wanted);
  }
  queue_.interpose([this] { between_frames(); });
}

void primitive_base_engine::hear_parameters(const std::string& line) {
  if (auto wanted = read_parameter_line(line); wanted.number > 0)
    use_parameters(std::move(wanted));
  else if (const auto answer = read_answer_line(line);
           answer.number > 0 && view_)
    view_->on_answer(answer.number, answer.problem);
}

/// Above all numbers that an earlier program of this instance has used, whose
/// answers may still come.
std::int64_t
primitive_base_engine::request_parameters(const std::string& changes) {
  using namespace std::chrono;
  if (!socket_.enabled() || changes.size() > most_request_bytes)
    return 0;
  const std::int64_t now =
      duration_cast<milliseconds>(system_clock::now().time_since_epoch())
          .count();
  auto last = last_request_.load();
  auto number = std::max(last + 1, now);
  while (!last_request_.compare_exchange_weak(last, number))
    number = std::max(last + 1, now);
  const auto text = std::to_string(number) + " " + changes;
  return socket_.send("ROSCELL_PARAMETERS_WANTED=" + text) == 0 ? number : 0;
}

/// One request does not push out the other.
void primitive_base_engine::between_frames() {
  if (safety_wanted_.exchange(false))
    pass_on_request();
  std::optional<changed_variables> reported;
  std::optional<ordered_parameters> wanted;
  {
    const std::lock_guard guard{reported_mutex_};
    reported.swap(reported_);
    wanted.swap(wanted_);
  }
  if (wanted)
    pass_on_parameters(*wanted);
  if (reported)
    move_to(*reported);
}

/// What the node waits for is said at once: from the next frame on they count.
void primitive_base_engine::pass_on_parameters(
    const ordered_parameters& wanted) {
  const auto number = std::to_string(wanted.number);
  alive_.work_begins(liveness::clock::now());
  try {
    const auto now = parameters::parse(wanted.values);
    executor_->on_parameters(now);
    if (view_)
      view_->show(now);
    socket_.send("ROSCELL_PARAMETERS_TAKEN=" + number);
    say_("it works with these parameters: " + wanted.values);
  } catch (...) {
    auto why = current_error();
    say_("it does not take other parameters: " + why);
    why.resize(std::min(why.size(), most_refusal_bytes));
    // A datagram has one line for each thing.
    std::replace(why.begin(), why.end(), '\n', ' ');
    socket_.send("ROSCELL_PARAMETERS_REFUSED=" + number + " " + why);
  }
  work_has_ended();
}

void primitive_base_engine::pass_on_request() {
  alive_.work_begins(liveness::clock::now());
  try {
    executor_->on_safety_wanted();
  } catch (...) {
    say_("on_safety_wanted failed: " + current_error());
  }
  work_has_ended();
}

} // namespace roscell::engine
