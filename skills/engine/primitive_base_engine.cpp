#include "skills/engine/primitive_base_engine.hpp"

#include "skills/engine/life/frame_words.hpp"

#include <chrono>
#include <cstring>
#include <utility>

namespace roscell::engine {

namespace {

constexpr std::size_t mib = 1024UL * 1024;

frame_queue::limits queue_limits(const parameters& options) {
  return {options.count("queue_length", 8, 1, 65536),
          options.count("queue_mib", 64, 1, 65536) * mib};
}

/// A skill that reads what it writes never comes to rest and fills the disk.
void check_no_loop(const environment& env) {
  for (const auto& in : env.inputs)
    for (const auto& out : env.outputs)
      if (in.protocol == out.protocol && in.endpoint == out.endpoint)
        throw start_error("'" + in.endpoint
                          + "' is both an input and an output of this step; "
                            "give the output an endpoint of its own");
}

} // namespace

/// An input with its thread. Numbers the frames on their way into the queue.
struct primitive_base_engine::input_port : frame_sink {
  input_port(std::size_t port, const stream& config, frame_queue& target,
             stream_meter& speed)
      : number(port), data_type(config.data_type), queue(target), meter(speed) {
    // nop
  }

  bool push(frame input, when_full policy) override {
    if (input.data_type.empty())
      input.data_type = data_type;
    input.port = number;
    input.sequence = next_sequence++;
    meter.count(stream_meter::clock::now());
    return queue.push(std::move(input), policy);
  }

  const std::size_t number;
  const std::string data_type;
  frame_queue& queue;
  stream_meter& meter;
  std::atomic<std::uint64_t> next_sequence{0};
  std::unique_ptr<input_handler> handler;
  std::thread thread;
};

primitive_base_engine::primitive_base_engine(const registry& parts,
                                             const environment& env,
                                             say_function say)
    : parts_(parts), env_(env), say_(std::move(say)),
      max_failures_(env.parameters.count("max_failures", 10, 1, 1'000'000'000)),
      queue_(env.inputs.size(), queue_limits(env.parameters)),
      alive_(env.watchdog.value_or(std::chrono::hours{24})),
      socket_(env.notify_socket), meters_(env.inputs.size(), env.outputs.size(),
                                          stream_meters::clock::now()) {
  // nop
}

primitive_base_engine::~primitive_base_engine() {
  request_stop();
  for (auto& input : inputs_)
    if (input->thread.joinable())
      input->thread.join();
}

exit_code primitive_base_engine::run() {
  try {
    check_no_loop(env_);
    make_parts();
    open_parts();
  } catch (...) {
    say_("cannot start: " + current_error());
    return exit_code::cannot_start;
  }
  report_ready();
  start_inputs();
  return finish(move_frames());
}

void primitive_base_engine::request_stop() {
  stop_.set();
  queue_.discard();
}

std::string primitive_base_engine::status() const {
  using namespace std::chrono;
  auto result = frame_words(times_, queue_.dropped(), failed_.load());
  if (const auto& ages = outputs_.ages(); ages.count() > 0) {
    const auto median = duration_cast<microseconds>(ages.quantile(0.5));
    result += " age_us=" + std::to_string(median.count());
  }
  return result;
}

void primitive_base_engine::make_parts() {
  executor_ = parts_.make_executor(env_);
  for (const auto& config : env_.outputs)
    outputs_.add(config, parts_.make_output({config, env_.parameters, say_}));
  for (const auto& config : env_.inputs) {
    const auto number = inputs_.size();
    auto input = std::make_unique<input_port>(number, config, queue_,
                                              meters_.input(number));
    input->handler = parts_.make_input({config, env_.parameters, say_});
    inputs_.push_back(std::move(input));
  }
}

void primitive_base_engine::open_parts() {
  outputs_.open();
  for (auto& input : inputs_)
    input->handler->open();
}

void primitive_base_engine::report_ready() {
  if (!socket_.enabled())
    return;
  if (auto error = socket_.send("READY=1"))
    say_("cannot report READY=1 to NOTIFY_SOCKET '" + env_.notify_socket
         + "': " + std::strerror(error)
         + "; the skill runs, but the node may not notice");
  heartbeat::words words{[this] { return status(); }, nullptr};
  if (env_.health)
    words.streams = [this](stream_meters::clock::time_point now) {
      return meters_.take_text(now);
    };
  heartbeat_.emplace(socket_, alive_, executor_->safety_, std::move(words));
}

void primitive_base_engine::start_inputs() {
  open_inputs_ = inputs_.size();
  for (auto& input : inputs_)
    input->thread = std::thread{[this, p = input.get()] { run_input(*p); }};
}

void primitive_base_engine::run_input(input_port& input) {
  try {
    input.handler->run(input, stop_);
  } catch (...) {
    say_("input " + std::to_string(input.number)
         + " broke: " + current_error());
    input_failed_ = true;
    request_stop();
  }
  if (--open_inputs_ == 0)
    queue_.close();
}

exit_code primitive_base_engine::move_frames() {
  while (auto input = queue_.pop()) {
    handle(*input);
    if (!outputs_.failure().empty())
      return exit_code::stream_failed;
    if (failed_in_row_ >= max_failures_) {
      say_("giving up after " + std::to_string(failed_in_row_)
           + " failures in a row; see parameter 'max_failures'");
      return exit_code::executor_failed;
    }
  }
  return input_failed_ ? exit_code::stream_failed : exit_code::done;
}

void primitive_base_engine::handle(const frame& input) {
  auto start = liveness::clock::now();
  alive_.work_begins(start);
  outputs_.begin(input);
  call_process(input);
  auto spent = liveness::clock::now() - start;
  times_.add(spent - outputs_.write_time());
  work_has_ended();
}

void primitive_base_engine::work_has_ended() {
  if (alive_.work_ends() && heartbeat_)
    heartbeat_->beat_now();
}

void primitive_base_engine::want_safety() {
  queue_.interpose([this] { pass_on_wish(); });
}

void primitive_base_engine::pass_on_wish() {
  alive_.work_begins(liveness::clock::now());
  try {
    executor_->on_safety_wanted();
  } catch (...) {
    say_("on_safety_wanted failed: " + current_error());
  }
  work_has_ended();
}

void primitive_base_engine::call_process(const frame& input) {
  std::string reason;
  try {
    executor_->process(input, outputs_);
    failed_in_row_ = 0;
    return;
  } catch (...) {
    reason = current_error();
  }
  ++failed_;
  ++failed_in_row_;
  // An output that broke is reported once, at the end.
  if (outputs_.failure().empty())
    say_("frame '" + input.name + "' failed (" + std::to_string(failed_in_row_)
         + " in a row): " + reason);
}

exit_code primitive_base_engine::finish(exit_code so_far) {
  request_stop();
  heartbeat_.reset();
  if (so_far == exit_code::done)
    socket_.send("STOPPING=1\nSTATUS=" + status());
  try {
    executor_->release();
  } catch (...) {
    say_("release failed: " + current_error());
    so_far = so_far == exit_code::done ? exit_code::executor_failed : so_far;
  }
  outputs_.close();
  if (!outputs_.failure().empty()) {
    say_("output broke: " + outputs_.failure());
    so_far = exit_code::stream_failed;
  }
  return so_far;
}

} // namespace roscell::engine
