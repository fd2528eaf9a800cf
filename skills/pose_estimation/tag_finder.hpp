#pragma once

#include "skills/pose_estimation/frame_keeper.hpp"
#include "skills/pose_estimation/frame_result.hpp"

#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace roscell::pose {

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
