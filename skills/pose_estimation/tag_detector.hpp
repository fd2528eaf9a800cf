#pragma once

#include "roscell/skill/parameters.hpp"
#include "skills/pose_estimation/tag_pose.hpp"
#include "skills/vision/brightness.hpp"

#include <apriltag/apriltag.h>

#include <array>
#include <memory>
#include <string>
#include <vector>

namespace roscell::pose {

/// How AprilTag 3 looks for tags:
///
/// | parameter | default | meaning |
/// |---|---|---|
/// | family | tag36h11 | one of tag36h11, tag25h9, tag16h5, tag36h10,
///   tagCircle21h7, tagCircle49h12, tagCustom48h12, tagStandard41h12 and
///   tagStandard52h13
/// | decimation | 2 | quads are looked for in an image so many times smaller
/// | blur | 0 | pixels of a Gaussian blur against noise; negative sharpens
/// | threads | 1 | threads that share the work
/// | refine | true | moves the edges of a quad to strong gradients nearby
/// | sharpening | 0.25 | of the bits before they are decoded
/// | max_hamming | 0 | wrong bits that are corrected, at most 2
struct detector_options {
  std::string family = "tag36h11";
  float decimation = 2;
  float blur = 0;
  int threads = 1;
  bool refine = true;
  double sharpening = 0.25;
  int max_hamming = 0;

  /// Throws start_error.
  static detector_options of(const engine::parameters& options);
};

/// A tag in an image. Pixels are counted as the library and apriltag_ros do it:
/// the upper left corner of the image is (0, 0).
struct tag_detection {
  int id = 0;
  int hamming = 0; ///< Bits that were corrected.
  float decision_margin = 0;
  Eigen::Vector2d centre; ///< pixels
  tag_corners corners;
  /// 3x3, row by row: from the tag's square [-1, 1] x [-1, 1] to pixels.
  std::array<double, 9> homography{};

  /// The corners as cameras are calibrated, where not the corner but the middle
  /// of the upper left pixel is (0, 0).
  tag_corners camera_corners() const;
};

/// The AprilTag 3 library.
class tag_detector {
public:
  /// Throws start_error when the family is unknown.
  explicit tag_detector(const detector_options& options);

  ~tag_detector();

  /// In the order of ids. The pixels are read where they lie, except that a
  /// blur without decimation needs a copy of its own. Throws
  /// std::invalid_argument when the image is larger than the library can count.
  std::vector<tag_detection> detect(const vision::gray_view& image);

  /// From the next image on it looks so for tags, but of the same family and
  /// with as many bits corrected.
  void adjust(const detector_options& options);

  const std::string& family() const noexcept {
    return options_.family;
  }

private:
  struct library;

  detector_options options_;
  std::vector<std::uint8_t> copy_;
  std::unique_ptr<library> library_;
};

using tag_family =
    std::unique_ptr<apriltag_family_t, void (*)(apriltag_family_t*)>;

/// Throws start_error, with the names that are known, when `name` is not.
tag_family make_tag_family(const std::string& name);

} // namespace roscell::pose
