#pragma once

#include "roscell/skill/handlers.hpp"
#include "skills/pose_estimation/frame_result.hpp"

#include <chrono>
#include <cstddef>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

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

/// Whose image it is.
struct image_origin {
  std::size_t source = 0;    ///< Number of the camera.
  std::size_t tree = 0;      ///< Output that its transforms go to.
  const std::string& camera; ///< What people call it.
  const std::string& prefix; ///< Of child frames.
};

/// Finds tags and bodies in images of one or more cameras, by the parameters
/// `tag_size_m`, `bundles` and those of `detector_options`.
///
/// A tag whose id is twice in an image belongs to no body and has no frame; a
/// frame that two cameras of one TF output see at a time is that of the first.
/// These, and tags that are not where their bundle says, are said once.
class tag_finder {
public:
  /// Throws start_error.
  tag_finder(const engine::parameters& options, engine::say_function say);

  /// Fills in family, tags and bundles of `result`. Without a camera there are
  /// no poses and no bundles.
  void find(const vision::gray_view& image,
            const std::optional<camera_model>& camera,
            const image_origin& origin, frame_result& result);

  /// From the next image on, see `tag_detector::adjust`. Throws start_error.
  void adjust(const engine::parameters& options) {
    detector_.adjust(detector_options::of(options));
  }

private:
  double size_of(int id) const;
  void keep_frames(const image_origin& origin, frame_result& result);
  void find_bundles(const camera_model& camera, const image_origin& origin,
                    frame_result& result);
  void say_once(const image_origin& origin, const std::string& line);

  const engine::say_function say_;
  const double tag_size_m_;
  tag_detector detector_;
  const std::vector<bundle> bundles_;
  std::map<int, double> sizes_m_; ///< By id, of tags of bundles.
  frame_keeper frames_;
  std::set<std::string> said_; ///< The same comes with every image.
};

} // namespace roscell::pose
