#include "tools/render_scenes/picture.hpp"

#include "tools/render_scenes/scene.hpp"

#include <apriltag/apriltag.h>
#include <apriltag/tag16h5.h>
#include <apriltag/tag25h9.h>
#include <apriltag/tag36h10.h>
#include <apriltag/tag36h11.h>
#include <apriltag/tagCircle21h7.h>
#include <apriltag/tagCircle49h12.h>
#include <apriltag/tagCustom48h12.h>
#include <apriltag/tagStandard41h12.h>
#include <apriltag/tagStandard52h13.h>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <stdexcept>

namespace roscell::scenes {

namespace {

constexpr double black = 25;
constexpr double white = 225;

struct known_family {
  const char* name;
  apriltag_family_t* (*create)();
  void (*destroy)(apriltag_family_t*);
};

constexpr known_family families[] = {
    {"tag16h5", tag16h5_create, tag16h5_destroy},
    {"tag25h9", tag25h9_create, tag25h9_destroy},
    {"tag36h10", tag36h10_create, tag36h10_destroy},
    {"tag36h11", tag36h11_create, tag36h11_destroy},
    {"tagCircle21h7", tagCircle21h7_create, tagCircle21h7_destroy},
    {"tagCircle49h12", tagCircle49h12_create, tagCircle49h12_destroy},
    {"tagCustom48h12", tagCustom48h12_create, tagCustom48h12_destroy},
    {"tagStandard41h12", tagStandard41h12_create, tagStandard41h12_destroy},
    {"tagStandard52h13", tagStandard52h13_create, tagStandard52h13_destroy},
};

const known_family& find_family(const std::string& name) {
  for (const auto& known : families)
    if (name == known.name)
      return known;
  std::string names;
  for (const auto& known : families)
    names += std::string{names.empty() ? "" : ", "} + known.name;
  throw std::runtime_error("family '" + name + "' is none of " + names);
}

/// The library has no function of its own to free this in Debian.
struct image_deleter {
  void operator()(image_u8_t* image) const {
    std::free(image->buf);
    std::free(image);
  }
};

cv::Mat cells_of(apriltag_family_t* family, unsigned id) {
  std::unique_ptr<image_u8_t, image_deleter> drawn{
      apriltag_to_image(family, static_cast<int>(id))};
  return cv::Mat(drawn->height, drawn->width, CV_8U, drawn->buf,
                 static_cast<std::size_t>(drawn->stride))
      .clone();
}

/// Soft shapes in mid gray, so that a detector has something to reject.
cv::Mat draw_background(const scene_options& options) {
  cv::RNG random{options.seed};
  cv::Mat coarse(options.height / 40 + 2, options.width / 40 + 2, CV_8U);
  random.fill(coarse, cv::RNG::UNIFORM, 70, 190);
  cv::Mat result;
  cv::resize(coarse, result, {options.width, options.height}, 0, 0,
             cv::INTER_CUBIC);
  return result;
}

/// Draws one tag, pixel by pixel of the rectangle around it.
class tag_drawing {
public:
  tag_drawing(const placed_tag& tag, const scene_options& options,
              const tag_sheet& sheet, const camera& eye)
      : tag_(tag), size_m_(options.tag_size_m), sheet_(sheet), eye_(eye),
        inverse_(tag.orientation.conjugate()),
        // A tag that looks away from the light is darker.
        light_(0.7
               + 0.3 * std::abs((inverse_ * tag.position.normalized()).z())) {
    // nop
  }

  void draw_into(cv::Mat& scene) const {
    const auto outline =
        corners_of(tag_, size_m_ * (1 + 2 * sheet_.margin()), eye_);
    Eigen::Array2d low = outline[0].array();
    Eigen::Array2d high = low;
    for (const auto& corner : outline) {
      low = low.min(corner.array());
      high = high.max(corner.array());
    }
    // Distortion may bend an edge outwards.
    constexpr auto bend_px = 8;
    for (auto y = std::max(0, static_cast<int>(low.y()) - bend_px);
         y < std::min<int>(scene.rows, static_cast<int>(high.y()) + bend_px);
         ++y)
      for (auto x = std::max(0, static_cast<int>(low.x()) - bend_px);
           x < std::min<int>(scene.cols, static_cast<int>(high.x()) + bend_px);
           ++x)
        draw_pixel(scene.at<std::uint8_t>(y, x), x, y);
  }

private:
  void draw_pixel(std::uint8_t& pixel, int x, int y) const {
    constexpr auto rays = 6;
    auto sum = 0.0;
    for (auto j = 0; j < rays; ++j)
      for (auto i = 0; i < rays; ++i) {
        auto shade =
            shade_at({x + (i + 0.5) / rays - 0.5, y + (j + 0.5) / rays - 0.5});
        sum += shade < 0 ? pixel : light_ * (shade == 0 ? black : white);
      }
    pixel = cv::saturate_cast<std::uint8_t>(sum / (rays * rays));
  }

  /// Where the ray of a pixel meets the plane of the tag.
  int shade_at(const Eigen::Vector2d& pixel) const {
    Eigen::Vector3d ray = inverse_ * eye_.ray_of(pixel);
    Eigen::Vector3d origin = inverse_ * -tag_.position;
    Eigen::Vector3d hit = (origin - ray * (origin.z() / ray.z())) / size_m_;
    return sheet_.shade(tag_.id, hit.x(), hit.y());
  }

  const placed_tag& tag_;
  const double size_m_;
  const tag_sheet& sheet_;
  const camera& eye_;
  const Eigen::Quaterniond inverse_;
  const double light_;
};

} // namespace

tag_sheet::tag_sheet(const std::string& family, unsigned tags) {
  const auto& known = find_family(family);
  std::unique_ptr<apriltag_family_t, void (*)(apriltag_family_t*)> made{
      known.create(), known.destroy};
  if (tags > made->ncodes)
    throw std::runtime_error(family + " has " + std::to_string(made->ncodes)
                             + " tags only");
  border_cells_ = made->width_at_border;
  for (auto id = 0U; id < tags; ++id)
    cells_.push_back(cells_of(made.get(), id));
}

std::vector<std::string> family_names() {
  std::vector<std::string> result;
  for (const auto& known : families)
    result.emplace_back(known.name);
  return result;
}

double tag_sheet::margin() const {
  return (cells_.front().cols / border_cells_ - 1) / 2;
}

int tag_sheet::border_cells() const {
  return static_cast<int>(border_cells_);
}

int tag_sheet::sheet_cells() const {
  return cells_.front().cols;
}

int tag_sheet::shade(int id, double x, double y) const {
  const auto& cells = cells_[static_cast<std::size_t>(id)];
  auto column =
      static_cast<int>(std::floor(x * border_cells_ + cells.cols / 2.0));
  auto row = static_cast<int>(std::floor(cells.rows / 2.0 - y * border_cells_));
  if (column < 0 || row < 0 || column >= cells.cols || row >= cells.rows)
    return -1;
  return cells.at<std::uint8_t>(row, column) > 127 ? 1 : 0;
}

cv::Mat draw_scene(const scene_options& options, const tag_sheet& sheet,
                   const std::vector<placed_tag>& tags) {
  auto result = draw_background(options);
  camera eye{options};
  for (const auto& tag : tags)
    tag_drawing{tag, options, sheet, eye}.draw_into(result);
  return result;
}

cv::Mat expose(const cv::Mat& scene, const scene_options& options,
               unsigned frame) {
  cv::Mat light;
  scene.convertTo(light, CV_32F);
  if (options.blur_px > 0)
    cv::GaussianBlur(light, light, {}, options.blur_px);
  cv::Mat noise(light.size(), CV_32F);
  cv::RNG random{options.seed * 1'000'003 + frame};
  random.fill(noise, cv::RNG::NORMAL, 0, options.noise);
  light += noise;
  cv::Mat result;
  light.convertTo(result, CV_8U);
  return result;
}

namespace {

using nlohmann::json;

json matrix(int rows, int columns, std::vector<double> values) {
  return {{"rows", rows}, {"cols", columns}, {"data", std::move(values)}};
}

json describe_camera(const scene_options& options) {
  const auto f = options.focal_px;
  const Eigen::Vector2d c = camera{options}.centre();
  return {
      {"image_width", options.width},
      {"image_height", options.height},
      {"camera_name", "rendered"},
      {"camera_matrix", matrix(3, 3, {f, 0, c.x(), 0, f, c.y(), 0, 0, 1})},
      {"distortion_model", "plumb_bob"},
      {"distortion_coefficients",
       matrix(1, 5, {options.distortion.begin(), options.distortion.end()})},
      {"rectification_matrix", matrix(3, 3, {1, 0, 0, 0, 1, 0, 0, 0, 1})},
      {"projection_matrix",
       matrix(3, 4, {f, 0, c.x(), 0, 0, f, c.y(), 0, 0, 0, 1, 0})}};
}

json describe_tag(const placed_tag& tag, const scene_options& options) {
  const auto& p = tag.position;
  const auto& q = tag.orientation;
  auto corners = json::array();
  for (const auto& c : corners_of(tag, options.tag_size_m, camera{options}))
    corners.push_back({c.x(), c.y()});
  return {{"id", tag.id},
          {"pose",
           {{"position", {p.x(), p.y(), p.z()}},
            {"orientation", {q.x(), q.y(), q.z(), q.w()}}}},
          {"corners_px", corners}};
}

void write_json(const json& document, const std::string& path) {
  std::ofstream file{path};
  file << document.dump(2) << '\n';
  if (!file.flush())
    throw std::runtime_error("cannot write '" + path + "'");
}

std::string frame_path(const std::string& folder, unsigned frame) {
  char name[32];
  std::snprintf(name, sizeof(name), "/frame_%03u.png", frame);
  return folder + name;
}

} // namespace

void render_scene(const scene_options& options, const std::string& folder) {
  tag_sheet sheet{options.family, options.tags};
  auto tags = place_tags(options, sheet.margin());
  auto scene = draw_scene(options, sheet, tags);
  std::filesystem::create_directories(folder);
  for (auto frame = 0U; frame < options.frames; ++frame) {
    auto path = frame_path(folder, frame);
    if (!cv::imwrite(path, expose(scene, options, frame)))
      throw std::runtime_error("cannot write '" + path + "'");
  }
  write_json(describe_camera(options), folder + "/camera.json");
  auto truth = json::array();
  for (const auto& tag : tags)
    truth.push_back(describe_tag(tag, options));
  write_json({{"family", options.family},
              {"tag_size_m", options.tag_size_m},
              {"tags", truth}},
             folder + "/truth.json");
}

} // namespace roscell::scenes
