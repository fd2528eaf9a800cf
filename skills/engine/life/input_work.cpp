#include "skills/engine/life/input_work.hpp"

namespace roscell::engine {

namespace {

/// The first frames of a camera may overtake what is needed to use them.
constexpr std::uint64_t patient_frames = 10;

} // namespace

input_work::input_work(const std::vector<std::string>& data_types) {
  for (const auto& type : data_types)
    inputs_.emplace_back().data_type = type;
  if (!data_types.empty())
    main_type_ = data_types.front();
}

void input_work::set_main(std::size_t input) {
  std::lock_guard guard{mutex_};
  main_type_ = inputs_.at(input).data_type;
}

bool input_work::is_main(std::size_t input) const {
  std::lock_guard guard{mutex_};
  return inputs_[input].data_type == main_type_;
}

void input_work::add(std::size_t input, const handled_frame& x) {
  std::lock_guard guard{mutex_};
  auto& to = inputs_[input];
  to.failed += x.failed ? 1 : 0;
  to.failed_in_row = x.failed ? to.failed_in_row + 1 : 0;
  to.fruitless = x.results == 0 ? to.fruitless + 1 : 0;
  to.was_fruitful = to.was_fruitful || x.results > 0;
  to.reason = x.reason;
  if (x.failed)
    return;
  to.times.add(x.time);
  if (to.data_type == main_type_)
    main_times_.add(x.time);
}

std::uint64_t input_work::failed(std::size_t input) const {
  std::lock_guard guard{mutex_};
  return inputs_[input].failed;
}

std::uint64_t input_work::failed_in_row(std::size_t input) const {
  std::lock_guard guard{mutex_};
  return inputs_[input].failed_in_row;
}

std::string input_work::remark() const {
  std::lock_guard guard{mutex_};
  for (const auto& x : inputs_) {
    if (x.data_type != main_type_ || x.fruitless < patient_frames
        || (x.was_fruitful && x.reason.empty()))
      continue;
    return std::to_string(x.fruitless) + " frames in"
           + (x.was_fruitful ? " since the last one out" : ", none out")
           + (x.reason.empty() ? "" : ": " + x.reason);
  }
  return {};
}

} // namespace roscell::engine
