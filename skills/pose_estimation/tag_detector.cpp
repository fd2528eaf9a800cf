#include "skills/pose_estimation/tag_detector.hpp"

#include "roscell/skill/errors.hpp"
#include "skills/vision/image_codec.hpp"

#include <apriltag/tag16h5.h>
#include <apriltag/tag25h9.h>
#include <apriltag/tag36h10.h>
#include <apriltag/tag36h11.h>
#include <apriltag/tagCircle21h7.h>
#include <apriltag/tagCircle49h12.h>
#include <apriltag/tagCustom48h12.h>
#include <apriltag/tagStandard41h12.h>
#include <apriltag/tagStandard52h13.h>

#include <algorithm>
#include <stdexcept>

namespace roscell::pose {

namespace {

using detector_ptr =
    std::unique_ptr<apriltag_detector_t, void (*)(apriltag_detector_t*)>;
using detections_ptr = std::unique_ptr<zarray_t, void (*)(zarray_t*)>;

/// The library thresholds in tiles of 4 pixels and reads out of bounds when an
/// image has not even one; no tag is as small as this.
constexpr auto least_side_px = 16.0F;

/// The library counts half pixels in 16 bits, and ends the process when memory
/// is short: it takes some 20 bytes a pixel.
void check_size(const vision::gray_view& image) {
  constexpr std::uint32_t longest_side_px = 32'000;
  if (image.width > longest_side_px || image.height > longest_side_px
      || std::uint64_t{image.width} * image.height > vision::max_picture_pixels)
    throw std::invalid_argument(
        "an image of " + std::to_string(image.width) + " x "
        + std::to_string(image.height)
        + " pixels is too large to look for tags; have the camera send at most "
        + std::to_string(longest_side_px) + " in a row and "
        + std::to_string(vision::max_picture_pixels) + " in all");
}

/// The library's table holds every code with up to `wrong_bits` bits changed,
/// in 48 bytes each, and the library ends the process when memory is short.
void check_table(const apriltag_family_t& family, int wrong_bits) {
  constexpr std::uint64_t most_entries = 2'000'000;
  std::uint64_t bits = family.nbits;
  std::uint64_t changes = 1;
  changes += wrong_bits > 0 ? bits : 0;
  changes += wrong_bits > 1 ? bits * (bits - 1) / 2 : 0;
  if (family.ncodes * changes > most_entries)
    throw engine::start_error("parameter 'max_hamming' is too large for the "
                              + std::to_string(family.ncodes) + " tags of "
                              + family.name + "; make it smaller");
}

tag_detection to_detection(const apriltag_detection_t& found) {
  tag_detection result;
  result.id = found.id;
  result.hamming = found.hamming;
  result.decision_margin = found.decision_margin;
  result.centre = {found.c[0], found.c[1]};
  for (auto i = 0; i < 4; ++i)
    result.corners[i] = {found.p[i][0], found.p[i][1]};
  std::copy_n(found.H->data, 9, result.homography.begin());
  return result;
}

} // namespace

detector_options detector_options::of(const engine::parameters& options) {
  detector_options result;
  result.family = options.text("family", result.family);
  result.decimation = static_cast<float>(
      options.number("decimation", result.decimation, 1, 16));
  result.blur =
      static_cast<float>(options.number("blur", result.blur, -10, 10));
  result.threads = static_cast<int>(options.count("threads", 1, 1, 64));
  result.refine = options.flag("refine", result.refine);
  result.sharpening = options.number("sharpening", result.sharpening, 0, 10);
  result.max_hamming = static_cast<int>(options.count("max_hamming", 0, 0, 2));
  return result;
}

tag_corners tag_detection::camera_corners() const {
  auto result = corners;
  for (auto& corner : result)
    corner -= Eigen::Vector2d{0.5, 0.5};
  return result;
}

struct tag_detector::library {
  explicit library(const std::string& family_name)
      : family(make_tag_family(family_name)),
        detector(apriltag_detector_create(), apriltag_detector_destroy) {
    // nop
  }

  // The detector uses the family until its end.
  tag_family family;
  detector_ptr detector;
};

tag_detector::tag_detector(const detector_options& options)
    : options_(options), library_(std::make_unique<library>(options.family)) {
  check_table(*library_->family, options_.max_hamming);
  adjust(options_);
  apriltag_detector_add_family_bits(
      library_->detector.get(), library_->family.get(), options_.max_hamming);
}

void tag_detector::adjust(const detector_options& options) {
  options_.decimation = options.decimation;
  options_.blur = options.blur;
  options_.threads = options.threads;
  options_.refine = options.refine;
  options_.sharpening = options.sharpening;
  auto& detector = *library_->detector;
  detector.quad_decimate = options_.decimation;
  detector.quad_sigma = options_.blur;
  detector.nthreads = options_.threads;
  detector.refine_edges = options_.refine;
  detector.decode_sharpening = options_.sharpening;
}

tag_detector::~tag_detector() = default;

std::vector<tag_detection>
tag_detector::detect(const vision::gray_view& image) {
  check_size(image);
  auto side = static_cast<float>(std::min(image.width, image.height));
  if (side / options_.decimation < least_side_px)
    return {};
  // The library's type has no const; it writes only when it blurs the image
  // itself instead of a smaller one.
  auto* pixels = const_cast<std::uint8_t*>(image.data);
  if (options_.blur != 0 && options_.decimation <= 1) {
    copy_.assign(image.data,
                 image.data + std::size_t{image.step} * image.height);
    pixels = copy_.data();
  }
  image_u8_t wrapped{static_cast<std::int32_t>(image.width),
                     static_cast<std::int32_t>(image.height),
                     static_cast<std::int32_t>(image.step), pixels};
  detections_ptr found{
      apriltag_detector_detect(library_->detector.get(), &wrapped),
      apriltag_detections_destroy};
  std::vector<tag_detection> result;
  for (auto i = 0; i < zarray_size(found.get()); ++i) {
    apriltag_detection_t* one = nullptr;
    zarray_get(found.get(), i, &one);
    result.push_back(to_detection(*one));
  }
  std::stable_sort(result.begin(), result.end(),
                   [](const auto& a, const auto& b) { return a.id < b.id; });
  return result;
}

namespace {

struct known_family {
  const char* name;
  apriltag_family_t* (*create)();
  void (*destroy)(apriltag_family_t*);
};

constexpr known_family families[] = {
    {"tag36h11", tag36h11_create, tag36h11_destroy},
    {"tag25h9", tag25h9_create, tag25h9_destroy},
    {"tag16h5", tag16h5_create, tag16h5_destroy},
    {"tag36h10", tag36h10_create, tag36h10_destroy},
    {"tagCircle21h7", tagCircle21h7_create, tagCircle21h7_destroy},
    {"tagCircle49h12", tagCircle49h12_create, tagCircle49h12_destroy},
    {"tagCustom48h12", tagCustom48h12_create, tagCustom48h12_destroy},
    {"tagStandard41h12", tagStandard41h12_create, tagStandard41h12_destroy},
    {"tagStandard52h13", tagStandard52h13_create, tagStandard52h13_destroy},
};

} // namespace

tag_family make_tag_family(const std::string& name) {
  std::string names;
  for (const auto& known : families) {
    if (name == known.name)
      return {known.create(), known.destroy};
    names += (names.empty() ? "" : ", ") + std::string{known.name};
  }
  throw engine::start_error("parameter 'family' is '" + name
                            + "', but must be one of: " + names);
}

} // namespace roscell::pose
