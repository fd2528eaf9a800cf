#pragma once

#include "roscell/skill/handlers.hpp"

#include <chrono>
#include <cstddef>
#include <map>
#include <set>
#include <string>
#include <utility>

namespace roscell::pose {

/// Keeps the frames that a skill sends to what TF can be: each has one parent
/// and one place. Says once what it leaves out, and the remedy.
class frame_keeper {
public:
  using clock = std::chrono::steady_clock;

  explicit frame_keeper(engine::say_function say) : say_(std::move(say)) {
    // nop
  }

  /// Whether camera number `source`, which people call `camera`, may send
  /// `frame` to output `tree`: no other has within a second.
  bool may_send(std::size_t tree, const std::string& frame, std::size_t source,
                const std::string& camera, clock::time_point now);

  /// Of more only twice those in view are remembered.
  static constexpr std::size_t most_frames = 1000;

  /// How many are remembered.
  std::size_t count() const noexcept {
    return owners_.size();
  }

  /// `frame` is twice in an image of `camera`.
  void refuse_twins(const std::string& frame, const std::string& camera);

private:
  struct owner {
    std::size_t source = 0;
    std::string camera;
    clock::time_point seen;
  };

  /// What nobody sees any more belongs to nobody: noise may look like each of
  /// tens of thousands of tags once.
  void forget_out_of_view(clock::time_point now);
  void say_once(const std::string& line);

  const engine::say_function say_;
  std::map<std::pair<std::size_t, std::string>, owner> owners_;
  std::size_t forget_at_ = most_frames;
  std::set<std::string> said_;
};

} // namespace roscell::pose
