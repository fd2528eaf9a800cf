#pragma once

#include "roscell/skill/environment.hpp"
#include "roscell/skill/executor.hpp"

#include <cstddef>
#include <optional>
#include <vector>

namespace roscell::vision {

/// A skill of cameras: the k-th CameraInfo input belongs to the k-th image
/// input. The two come on different ways, in any order, so that an image may
/// wait for the CameraInfo of its stamp: one of each camera, until the next one
/// comes.
class paired_executor : public engine::executor {
public:
  void process(const engine::frame& input, engine::emitter& output) final;

protected:
  /// The first image input is the main one.
  explicit paired_executor(const std::vector<engine::stream>& inputs);

  /// Input ports by the number of their camera.
  const std::vector<std::size_t>& image_ports() const noexcept {
    return image_ports_;
  }

  const std::vector<std::size_t>& info_ports() const noexcept {
    return info_ports_;
  }

  /// The number of the camera to which an input port belongs.
  std::size_t camera_of(std::size_t port) const {
    return camera_of_port_.at(port);
  }

private:
  virtual void calibrate(std::size_t camera, const engine::frame& info) = 0;

  /// Whether an image has to wait; asked once for each.
  virtual bool should_wait(std::size_t camera, const engine::frame& image) = 0;

  /// @param image of the input port that it names, now or in an earlier call.
  virtual void process_image(const engine::frame& image,
                             engine::emitter& output) = 0;

  void take_info(const engine::frame& info, engine::emitter& output);
  void take_image(const engine::frame& image, engine::emitter& output);

  std::vector<std::size_t> image_ports_;
  std::vector<std::size_t> info_ports_;
  std::vector<std::size_t> camera_of_port_;
  std::vector<std::optional<engine::frame>> waiting_; ///< By camera.
};

} // namespace roscell::vision
