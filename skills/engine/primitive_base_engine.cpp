#include "skills/engine/primitive_base_engine.hpp"

#include "skills/engine/life/processing_times.hpp"

#include <algorithm>
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

std::vector<std::string> data_types_of(const std::vector<stream>& streams) {
  std::vector<std::string> result;
  for (const auto& x : streams)
    result.push_back(x.data_type);
  return result;
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
      socket_(env.notify_socket), work_(data_types_of(env.inputs)),
      meters_(env.inputs.size(), env.outputs.size(),
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

void primitive_base_engine::make_parts() {
  executor_ = parts_.make_executor(env_);
  work_.set_main(executor_->main_input_);
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
  view_ = parts_.make_parameter_view(env_, say_,
                                     [this](const std::string& changes) {
                                       return request_parameters(changes);
                                     });
  if (view_)
    view_->open(env_.parameters);
}

bool primitive_base_engine::survives_new_address() const {
  return !executor_->bound_to_address_ && outputs_.survive_new_address()
         && std::all_of(inputs_.begin(), inputs_.end(), [](const auto& input) {
              return input->handler->survives_new_address();
            });
}

/// A node starts a skill again that does not hear of another address.
void primitive_base_engine::listen_to_node() {
  std::vector<heard_lines> heard{
      {env_.notify_socket + ".parameters",
       [this](const std::string& line) { hear_parameters(line); }}};
  if (survives_new_address())
    heard.push_back(
        {env_.notify_socket + ".environment", [this](const std::string& line) {
           if (auto reported = read_changed_variables(line); !reported.empty())
             use_variables(std::move(reported));
         }});
  news_.emplace(std::move(heard));
}

void primitive_base_engine::report_ready() {
  if (!socket_.enabled())
    return;
  listen_to_node();
  if (auto error = socket_.send("READY=1"))
    say_("cannot report READY=1 to NOTIFY_SOCKET '" + env_.notify_socket
         + "': " + std::strerror(error)
         + "; the skill runs, but the node may not notice");
  heartbeat::words words{[this] { return reported_status(); }, nullptr};
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
    stream_failed_ = true;
    request_stop();
  }
  if (--open_inputs_ == 0)
    queue_.close();
}

exit_code primitive_base_engine::move_frames() {
  while (auto input = queue_.pop()) {
    const auto port = handle(*input);
    if (!outputs_.failure().empty())
      return exit_code::stream_failed;
    if (gives_up(port))
      return exit_code::executor_failed;
  }
  return stream_failed_ ? exit_code::stream_failed : exit_code::done;
}

/// Returns the input that the work was for: another one, where a frame of that
/// had been kept.
std::size_t primitive_base_engine::handle(const frame& input) {
  auto start = liveness::clock::now();
  alive_.work_begins(start);
  outputs_.begin(input);
  const auto failure = call_process(input);
  const auto spent = liveness::clock::now() - start;
  const bool failed = !failure.empty();
  const auto port =
      std::exchange(executor_->worked_on_, std::nullopt).value_or(input.port);
  const auto is_kept = std::exchange(executor_->kept_, false);
  if (!is_kept || failed)
    work_.add(port, {spent - outputs_.write_time(), failed, outputs_.emitted(),
                     failed ? failure : outputs_.excuse()});
  // An output that broke is reported once, at the end.
  if (failed && outputs_.failure().empty())
    say_failure(input, port, failure);
  work_has_ended();
  return port;
}

void primitive_base_engine::work_has_ended() {
  if (alive_.work_ends() && heartbeat_)
    heartbeat_->send_now();
}

/// No thread uses an output meanwhile, and what an input still brings waits in
/// the queue.
void primitive_base_engine::move_to(const changed_variables& reported) {
  using namespace std::chrono;
  const auto start = liveness::clock::now();
  alive_.work_begins(start);
  try {
    make_connections_anew(reported);
    const auto spent = liveness::clock::now() - start;
    say_("this host has another address: inputs and outputs were made anew in "
         + std::to_string(duration_cast<milliseconds>(spent).count()) + " ms");
  } catch (...) {
    say_("cannot go on at another address of this host: " + current_error());
    stream_failed_ = true;
    request_stop();
  }
  work_has_ended();
}

/// What several of them share is gone before one of them needs it again.
void primitive_base_engine::make_connections_anew(
    const changed_variables& reported) {
  for (auto& input : inputs_)
    input->handler->suspend();
  outputs_.suspend();
  if (view_)
    view_->suspend();
  outputs_.resume(reported);
  for (auto& input : inputs_)
    input->handler->resume(reported);
  if (view_)
    view_->resume(reported);
}

std::string primitive_base_engine::call_process(const frame& input) {
  try {
    executor_->process(input, outputs_);
    return {};
  } catch (const unusable_input& e) {
    useless_ = true;
    return e.what();
  } catch (...) {
    const auto reason = current_error();
    return reason.empty() ? "an error without a word" : reason;
  }
}

void primitive_base_engine::say_failure(const frame& input, std::size_t port,
                                        const std::string& reason) const {
  if (useless_)
    return say_("giving up: '" + env_.inputs[port].endpoint + "' brings "
                + reason);
  say_("frame '" + input.name + "' failed ("
       + std::to_string(work_.failed_in_row(port)) + " in a row): " + reason);
}

bool primitive_base_engine::gives_up(std::size_t input) const {
  if (useless_)
    return true;
  const auto failed = work_.failed_in_row(input);
  if (failed < max_failures_)
    return false;
  say_("giving up after " + std::to_string(failed)
       + " failures in a row at input '" + env_.inputs[input].endpoint
       + "'; see parameter 'max_failures'");
  return true;
}

exit_code primitive_base_engine::finish(exit_code so_far) {
  request_stop();
  news_.reset();
  view_.reset();
  heartbeat_.reset();
  if (so_far == exit_code::done)
    socket_.send("STOPPING=1\n" + reported_status());
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
