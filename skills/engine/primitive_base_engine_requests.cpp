#include "skills/engine/primitive_base_engine.hpp"

#include <algorithm>
#include <utility>

/// What a node asks of an engine that runs: it is done between two frames.
namespace roscell::engine {

namespace {

/// A node reads no more of a reason.
constexpr std::size_t most_refusal_bytes = 512;

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
