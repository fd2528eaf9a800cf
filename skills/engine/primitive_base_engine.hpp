#pragma once

#include "roscell/skill/errors.hpp"
#include "roscell/skill/registry.hpp"
#include "skills/engine/frame_queue.hpp"
#include "skills/engine/life/heartbeat.hpp"
#include "skills/engine/life/liveness.hpp"
#include "skills/engine/life/notify_socket.hpp"
#include "skills/engine/life/processing_times.hpp"
#include "skills/engine/life/stream_meters.hpp"
#include "skills/engine/output_ports.hpp"

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

namespace roscell::engine {

/// The engine of a primitive skill: input handlers -> executor -> output
/// handlers, each made at run time by protocol and implementation model. It
/// understands these parameters, and hands all of them on:
///
/// | parameter | default | meaning |
/// |---|---|---|
/// | queue_length | 8 | frames of one input that may wait for the executor |
/// | queue_mib | 64 | their size together; a single frame may be larger |
/// | max_failures | 10 | calls of `process` in a row that may fail |
class primitive_base_engine {
public:
  /// Both arguments must outlive the engine. `say` gets one line at a time,
  /// from several threads.
  primitive_base_engine(const registry& parts, const environment& env,
                        say_function say);

  ~primitive_base_engine();

  /// Makes and opens the three parts, reports READY=1, and moves frames until
  /// it is stopped or all inputs have ended. To be called once.
  exit_code run();

  /// Makes `run` return after the current frame. May be called from any
  /// thread, at any time, repeatedly.
  void request_stop();

  /// Tells the executor, between two frames, that somebody waits for it to be
  /// safe. May be called from any thread, at any time, repeatedly.
  void want_safety();

  /// For instance `frames=120 dropped=0 failed=0 median_us=85 p99_us=210
  /// times_us=10900 times=119,1,0,0,0,0,0,0,0,0,0 age_us=4200`: frames
  /// processed, dropped before that, failed among the processed ones, and the
  /// times that `process` took without its output. May be called from any
  /// thread.
  std::string status() const;

private:
  struct input_port;

  void make_parts();
  void open_parts();
  void report_ready();
  void start_inputs();
  void run_input(input_port& input);
  exit_code move_frames();
  void handle(const frame& input);
  void call_process(const frame& input);
  void pass_on_wish();
  void work_has_ended();
  exit_code finish(exit_code so_far);

  const registry& parts_;
  const environment& env_;
  const say_function say_;
  const std::uint64_t max_failures_;
  stop_event stop_;
  frame_queue queue_;
  liveness alive_;
  notify_socket socket_;
  processing_times times_;
  stream_meters meters_;
  std::vector<std::unique_ptr<input_port>> inputs_;
  std::unique_ptr<executor> executor_;
  output_ports outputs_{meters_};
  std::optional<heartbeat> heartbeat_;
  std::atomic<std::size_t> open_inputs_{0};
  std::atomic<bool> input_failed_{false};
  std::atomic<std::uint64_t> failed_{0};
  std::uint64_t failed_in_row_ = 0;
};

} // namespace roscell::engine
