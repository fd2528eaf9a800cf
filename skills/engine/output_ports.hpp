#pragma once

#include "roscell/skill/executor.hpp"
#include "roscell/skill/handlers.hpp"
#include "skills/engine/life/processing_times.hpp"
#include "skills/engine/life/stream_meters.hpp"

#include <chrono>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace roscell::engine {

/// The outputs of a skill as its executor sees them: fills in what an emitted
/// frame leaves open, and hands it to the output handler.
class output_ports : public emitter {
public:
  /// `meters` must outlive this object.
  explicit output_ports(stream_meters& meters) : meters_(meters) {
    // nop
  }

  void add(const stream& config, std::unique_ptr<output_handler> handler);

  /// Throws start_error.
  void open();

  /// Frames emitted from now on are results of `input`, which must stay alive
  /// until the next call.
  void begin(const frame& input);

  /// How many frames have been emitted since `begin`.
  std::size_t emitted() const noexcept {
    return emitted_;
  }

  /// What has been said since `begin` of why nothing comes of the input.
  const std::string& excuse() const noexcept {
    return excuse_;
  }

  /// Time spent in output handlers since `begin`.
  std::chrono::steady_clock::duration write_time() const noexcept {
    return write_time_;
  }

  /// How old the data of results were when they had been written, by this
  /// host's clock; what is said to come from the future is left out.
  const processing_times& ages() const noexcept {
    return ages_;
  }

  /// Why an output broke, or empty. Kept here because an executor may catch
  /// the exception.
  const std::string& failure() const noexcept {
    return failure_;
  }

  bool survive_new_address() const;
  void suspend();

  /// Throws start_error.
  void resume(const changed_variables& reported);

  /// Closes all outputs; what goes wrong is found in `failure`.
  void close();

private:
  struct port {
    stream config;
    std::unique_ptr<output_handler> handler;
    std::uint64_t sequence = 0;
  };

  void write(frame result, std::size_t number) override;
  void explain(std::string reason) override;
  void fill_in(frame& result, port& target);

  stream_meters& meters_;
  std::vector<port> ports_;
  const frame* input_ = nullptr;
  std::size_t emitted_ = 0;
  std::string excuse_;
  std::chrono::steady_clock::duration write_time_{};
  processing_times ages_;
  std::string failure_;
};

} // namespace roscell::engine
