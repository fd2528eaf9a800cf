#pragma once

#include "roscell/skill/errors.hpp"
#include "roscell/skill/registry.hpp"
#include "skills/engine/frame_queue.hpp"
#include "skills/engine/life/heartbeat.hpp"
#include "skills/engine/life/processing_times.hpp"
#include "skills/engine/life/signal_watch.hpp"
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
/// | max_failures | 10 | frames of one input in a row that may fail |
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
  /// stop-safe. May be called from any thread, at any time, repeatedly.
  void want_safety();

  /// Has inputs and outputs go on, between two frames, where these variables
  /// lead; of what is said meanwhile the last word counts. `run` returns where
  /// they cannot. May be called from any thread, at any time, repeatedly.
  void use_variables(changed_variables reported);

  /// Has the executor take these parameters between two frames, and tells the
  /// node what became of it; of what is told meanwhile the last word counts.
  /// May be called from any thread, at any time, repeatedly.
  void use_parameters(ordered_parameters wanted);

  /// For instance `frames=120 dropped=0 failed=0 median_us=85 p99_us=210
  /// times_us=10900 times=119,1,0,0,0,0,0,0,0,0,0 age_us=4200`: of the input
  /// that the skill works on, frames processed, dropped before that, failed,
  /// and the times that `process` took without its output. May be called from
  /// any thread.
  std::string status() const;

  /// What has gone through each stream, as a node reads it in ROSCELL_FRAMES:
  /// "input:0 120 118 2 0 85;output:0 118": frames that have come, were
  /// processed, failed, were dropped, and the median time in microseconds; and
  /// those that were written. May be called from any thread.
  std::string frame_counts() const;

  /// One sentence where nothing comes of many frames, see `input_work`; a step
  /// without outputs has none. May be called from any thread.
  std::string remark() const {
    return env_.outputs.empty() ? "" : work_.remark();
  }

private:
  struct input_port;

  void make_parts();
  void open_parts();
  bool survives_new_address() const;
  void listen_to_node();
  void report_ready();
  void start_inputs();
  void run_input(input_port& input);
  exit_code move_frames();
  std::size_t handle(const frame& input);
  std::string call_process(const frame& input);
  void say_failure(const frame& input, std::size_t port,
                   const std::string& reason) const;
  bool gives_up(std::size_t input) const;
  std::string reported_status() const;
  void between_frames();
  std::int64_t request_parameters(const std::string& changes);
  void hear_parameters(const std::string& line);
  void pass_on_request();
  void pass_on_parameters(const ordered_parameters& wanted);
  void move_to(const changed_variables& reported);
  void make_connections_anew(const changed_variables& reported);
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
  input_work work_;
  stream_meters meters_;
  std::vector<std::unique_ptr<input_port>> inputs_;
  std::unique_ptr<executor> executor_;
  output_ports outputs_{meters_};
  bool useless_ = false; ///< What an input brings can never be used.
  std::unique_ptr<parameter_view> view_; ///< Null: nobody sees parameters.
  std::atomic<std::int64_t> last_request_{0};
  std::optional<heartbeat> heartbeat_;
  std::atomic<std::size_t> open_inputs_{0};
  std::atomic<bool> stream_failed_{false};
  std::atomic<bool> safety_wanted_{false};
  std::mutex reported_mutex_; // Guards what follows.
  std::optional<changed_variables> reported_;
  std::optional<ordered_parameters> wanted_;
  std::optional<fifo_watch> news_; // Calls until it is gone.
};

} // namespace roscell::engine
