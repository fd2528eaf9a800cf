#include "embedding/skills/skill_side.hpp"

#include "actors/core/clocks.hpp"
#include "messages/stream_protocols.hpp"
#include "roscell/skill/errors.hpp"

#include <stdexcept>
#include <utility>

namespace roscell {

using embedding::shared_frame;

namespace {

constexpr std::size_t mib = 1024UL * 1024;

/// As an executor's queue has them.
embedding::inbox_limits limits_of(const engine::parameters& options) {
  return {options.count("queue_length", 8, 1, 65536),
          options.count("queue_mib", 64, 1, 65536) * mib};
}

} // namespace

/// An input by another protocol than "actor", with its thread.
struct actor_skill_context::impl::input_port : engine::frame_sink {
  input_port(std::size_t number, std::string data_type,
             embedding::frame_inbox& to)
      : number(number), data_type(std::move(data_type)), to(to) {}

  bool push(engine::frame x, engine::when_full policy) override {
    if (x.data_type.empty())
      x.data_type = data_type;
    x.port = number;
    return to.push(number, std::make_shared<const engine::frame>(std::move(x)),
                   policy);
  }

  const std::size_t number;
  const std::string data_type;
  embedding::frame_inbox& to;
  std::unique_ptr<engine::input_handler> handler;
  std::thread thread;
};

actor_skill_context::impl::impl(engine::environment env, engine::registry parts,
                                std::shared_ptr<embedding::frame_hub> hub,
                                std::shared_ptr<embedding::line_ring> log,
                                ears keeper)
    : env_(std::move(env)), parts_(std::move(parts)), hub_(std::move(hub)),
      log_(std::move(log)), keeper_(std::move(keeper)),
      inbox_(std::make_shared<embedding::frame_inbox>(
          env_.inputs.size(), limits_of(env_.parameters), keeper_.on_frames)) {}

actor_skill_context::impl::~impl() {
  close();
}

void actor_skill_context::impl::open_input(std::size_t port) {
  const auto& config = env_.inputs[port];
  if (config.protocol == protocols::actor)
    return hub_->subscribe(config.endpoint, inbox_, port);
  auto x = std::make_unique<input_port>(port, config.data_type, *inbox_);
  x->handler =
      parts_.make_input({config, env_.parameters,
                         [this](const std::string& line) { log(line); }});
  x->handler->open();
  inputs_.push_back(std::move(x));
}

void actor_skill_context::impl::open() {
  for (const auto& config : env_.outputs) {
    output_port x{config, nullptr};
    if (config.protocol != protocols::actor) {
      x.handler =
          parts_.make_output({config, env_.parameters,
                              [this](const std::string& line) { log(line); }});
      x.handler->open();
    }
    outputs_.push_back(std::move(x));
  }
  for (std::size_t port = 0; port < env_.inputs.size(); ++port)
    open_input(port);
}

void actor_skill_context::impl::start_inputs() {
  for (auto& x : inputs_)
    x->thread = std::thread{[this, p = x.get()] { run_input(*p); }};
}

void actor_skill_context::impl::run_input(input_port& x) {
  try {
    x.handler->run(x, stop_);
  } catch (...) {
    log("input " + std::to_string(x.number)
        + " broke: " + engine::current_error());
  }
}

void actor_skill_context::impl::close() {
  stop_.set();
  inbox_->close();
  for (auto& x : inputs_)
    if (x->thread.joinable())
      x->thread.join();
  std::lock_guard<std::mutex> lock{output_mutex_};
  if (std::exchange(closed_, true))
    return;
  for (auto& x : outputs_) {
    if (x.handler == nullptr)
      continue;
    try {
      x.handler->close();
    } catch (...) {
      log("an output broke: " + engine::current_error());
    }
  }
}

void actor_skill_context::impl::ready() {
  if (!is_ready_.exchange(true))
    keeper_.on_ready();
}

void actor_skill_context::impl::set_safe(bool safe) {
  const auto word = safe ? safe_word::safe : safe_word::unsafe;
  if (safety_.exchange(word) != word && !safety_waits_.exchange(true))
    keeper_.on_safety();
}

safe_word actor_skill_context::impl::take_safety() {
  // First this: what is said between the two is told once more.
  safety_waits_ = false;
  return safety_;
}

void actor_skill_context::impl::on_safety_wanted(std::function<void()> call) {
  std::lock_guard<std::mutex> lock{request_mutex_};
  on_safety_wanted_ = std::move(call);
}

void actor_skill_context::impl::want_safety() {
  std::unique_lock<std::mutex> lock{request_mutex_};
  const auto call = on_safety_wanted_;
  lock.unlock();
  try {
    if (call)
      call();
  } catch (...) {
    log("on_safety_wanted failed: " + engine::current_error());
  }
}

void actor_skill_context::impl::log(const std::string& line) {
  // As the shim does it for programs.
  log_->add(line, clock_ms(CLOCK_REALTIME));
}

void actor_skill_context::impl::write(const shared_frame& x, output_port& to) {
  if (closed_)
    return;
  if (to.handler == nullptr)
    hub_->publish(to.config.endpoint, x);
  else
    to.handler->write(*x);
}

void actor_skill_context::impl::emit(shared_frame x, std::size_t port) {
  std::lock_guard<std::mutex> lock{output_mutex_};
  write(x, outputs_.at(port));
}

void actor_skill_context::impl::emit(engine::frame x, std::size_t port) {
  std::lock_guard<std::mutex> lock{output_mutex_};
  auto& to = outputs_.at(port);
  if (x.data_type.empty())
    x.data_type = to.config.data_type;
  if (x.time == std::chrono::system_clock::time_point{})
    x.time = std::chrono::system_clock::now();
  x.sequence = to.sequence++;
  write(std::make_shared<const engine::frame>(std::move(x)), to);
}

actor_skill_context::actor_skill_context(std::shared_ptr<impl> x)
    : impl_(std::move(x)) {}

const engine::environment& actor_skill_context::environment() const {
  return impl_->environment();
}

void actor_skill_context::ready() const {
  impl_->ready();
}

void actor_skill_context::set_safe(bool safe) const {
  impl_->set_safe(safe);
}

void actor_skill_context::on_safety_wanted(std::function<void()> call) const {
  impl_->on_safety_wanted(std::move(call));
}

void actor_skill_context::log(const std::string& line) const {
  impl_->log(line);
}

void actor_skill_context::emit(engine::frame result, std::size_t port) const {
  impl_->emit(std::move(result), port);
}

void actor_skill_context::emit(std::shared_ptr<const engine::frame> result,
                               std::size_t port) const {
  impl_->emit(std::move(result), port);
}

} // namespace roscell
