#pragma once

#include "embedding/skills/frame_inbox.hpp"
#include "embedding/skills/line_ring.hpp"
#include "messages/life.hpp"
#include "roscell/actor_skill.hpp"
#include "roscell/skill/handlers.hpp"
#include "roscell/skill/registry.hpp"
#include "roscell/skill/stop_event.hpp"

#include <atomic>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace roscell {

/// What stands between an instance and the rest: its streams and its log.
class actor_skill_context::impl {
public:
  /// What the keeper hears of its instance, from any thread.
  struct ears {
    std::function<void()> on_ready;  ///< Once.
    std::function<void()> on_frames; ///< As `frame_inbox` wakes.
    /// Once for all words until `take_safety`.
    std::function<void()> on_safety;
  };

  impl(engine::environment env, engine::registry parts,
       std::shared_ptr<embedding::frame_hub> hub,
       std::shared_ptr<embedding::line_ring> log, ears keeper);

  ~impl();

  /// Opens every stream, which may take some time: with DDS 20 ms. Throws
  /// engine::start_error.
  void open();

  /// Frames come in from now on.
  void start_inputs();

  /// Ends the inputs and waits for their threads; then hands over what outputs
  /// hold back.
  void close();

  void ready();
  void set_safe(bool safe);
  void on_safety_wanted(std::function<void()> call);

  /// What the instance has said last of its safety.
  safe_word take_safety();

  /// Passes on that somebody waits for it to be stop-safe.
  void want_safety();

  void log(const std::string& line);
  void emit(embedding::shared_frame x, std::size_t port);
  void emit(engine::frame x, std::size_t port);

  const engine::environment& environment() const noexcept {
    return env_;
  }

  embedding::frame_inbox& inbox() noexcept {
    return *inbox_;
  }

private:
  struct input_port;
  struct output_port {
    engine::stream config;
    std::unique_ptr<engine::output_handler> handler; // Null: within us.
    std::uint64_t sequence = 0;
  };

  void open_input(std::size_t port);
  void run_input(input_port& x);
  void write(const embedding::shared_frame& x, output_port& to);

  const engine::environment env_;
  const engine::registry parts_;
  const std::shared_ptr<embedding::frame_hub> hub_;
  const std::shared_ptr<embedding::line_ring> log_;
  const ears keeper_;
  const std::shared_ptr<embedding::frame_inbox> inbox_;
  std::atomic<bool> is_ready_{false};
  std::atomic<safe_word> safety_{safe_word::untold};
  std::atomic<bool> safety_waits_{false}; ///< The keeper is to take it.
  std::mutex request_mutex_;              // Guards what follows.
  std::function<void()> on_safety_wanted_;
  engine::stop_event stop_;
  std::vector<std::unique_ptr<input_port>> inputs_;
  std::mutex output_mutex_; // Guards what follows.
  std::vector<output_port> outputs_;
  bool closed_ = false;
};

} // namespace roscell
