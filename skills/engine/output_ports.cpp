#include "skills/engine/output_ports.hpp"

#include "roscell/skill/errors.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace roscell::engine {

void output_ports::add(const stream& config,
                       std::unique_ptr<output_handler> handler) {
  ports_.push_back({config, std::move(handler)});
}

void output_ports::open() {
  for (auto& p : ports_)
    p.handler->open();
}

bool output_ports::survive_new_address() const {
  return std::all_of(ports_.begin(), ports_.end(), [](const port& p) {
    return p.handler->survives_new_address();
  });
}

void output_ports::suspend() {
  for (auto& p : ports_)
    p.handler->suspend();
}

void output_ports::resume(const changed_variables& reported) {
  for (auto& p : ports_)
    p.handler->resume(reported);
}

void output_ports::begin(const frame& input) {
  input_ = &input;
  emitted_ = 0;
  excuse_.clear();
  write_time_ = {};
}

void output_ports::close() {
  for (auto& p : ports_) {
    try {
      p.handler->close();
    } catch (...) {
      failure_ = current_error();
    }
  }
}

void output_ports::write(frame result, std::size_t number) {
  if (number >= ports_.size())
    throw std::out_of_range("the executor emits to output "
                            + std::to_string(number) + ", but the step has "
                            + std::to_string(ports_.size()) + " outputs");
  if (!failure_.empty())
    throw stream_error(failure_);
  auto& target = ports_[number];
  fill_in(result, target);
  auto start = std::chrono::steady_clock::now();
  try {
    target.handler->write(result);
  } catch (...) {
    failure_ = current_error();
    throw;
  }
  const auto end = std::chrono::steady_clock::now();
  write_time_ += end - start;
  meters_.output(number).count(end);
  const auto age = std::chrono::system_clock::now() - result.time;
  if (age >= age.zero())
    ages_.add(age);
}

void output_ports::explain(std::string reason) {
  excuse_ = std::move(reason);
}

void output_ports::fill_in(frame& result, port& target) {
  if (result.data_type.empty())
    result.data_type = target.config.data_type;
  if (result.time == std::chrono::system_clock::time_point{})
    result.time = input_->time;
  // Several results of one input must not share a name: a folder holds one
  // file per name.
  if (result.name.empty())
    result.name = emitted_ == 0 ? input_->name
                                : input_->name + "." + std::to_string(emitted_);
  ++emitted_;
  result.port = input_->port;
  result.sequence = target.sequence++;
}

} // namespace roscell::engine
