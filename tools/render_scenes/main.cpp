#include "tools/render_scenes/picture.hpp"

#include <CLI/CLI.hpp>

#include <iostream>
#include <vector>

namespace {

using roscell::scenes::scene_options;

void add_options(CLI::App& app, scene_options& scene) {
  app.add_option("--family", scene.family, "Tag family");
  app.add_option("--frames", scene.frames, "Frames per scene")
      ->check(CLI::Range(1, 1000));
  app.add_option("--seed", scene.seed, "Another seed gives other poses");
  app.add_option("--tag-size", scene.tag_size_m, "Metres across a tag")
      ->check(CLI::Range(0.001, 10.0));
  app.add_option("--width", scene.width, "Pixels across a picture")
      ->check(CLI::Range(64, 8192));
  app.add_option("--height", scene.height, "Rows of a picture")
      ->check(CLI::Range(64, 8192));
  app.add_option("--focal", scene.focal_px, "Focal length in pixels")
      ->check(CLI::Range(10.0, 100'000.0));
  app.add_option("--distortion", scene.distortion, "k1 k2 p1 p2 k3");
  app.add_option("--nearest", scene.nearest_m, "Least distance in metres")
      ->check(CLI::Range(0.01, 100.0));
  app.add_option("--farthest", scene.farthest_m, "Most distance in metres")
      ->check(CLI::Range(0.01, 100.0));
  app.add_option("--tilt", scene.most_tilt_deg, "Most tilt in degrees")
      ->check(CLI::Range(0.0, 80.0));
  app.add_option("--blur", scene.blur_px, "Standard deviation in pixels")
      ->check(CLI::Range(0.0, 10.0));
  app.add_option("--noise", scene.noise, "Standard deviation of 255 levels")
      ->check(CLI::Range(0.0, 100.0));
}

} // namespace

int main(int argc, char** argv) {
  CLI::App app{"Renders pictures of AprilTags at known poses: for each number "
               "of tags a folder\nscene_1, scene_2, ... with frames, "
               "camera.json and truth.json."};
  app.option_defaults()->always_capture_default();
  std::string folder;
  std::vector<unsigned> tags{4, 8, 24, 48};
  scene_options scene;
  app.add_option("DIR", folder, "Where the scenes go")->required();
  app.add_option("--tags", tags, "Tags in each scene")
      ->delimiter(',')
      ->check(CLI::Range(1, 1000));
  add_options(app, scene);
  CLI11_PARSE(app, argc, argv);
  try {
    for (std::size_t i = 0; i < tags.size(); ++i) {
      auto number = std::to_string(i + 1);
      scene.tags = tags[i];
      render_scene(scene, folder + "/scene_" + number);
      ++scene.seed;
      std::cout << "scene_" << number << ": " << scene.tags << " tags, "
                << scene.frames << " frames\n";
    }
  } catch (const std::exception& e) {
    std::cerr << "render_scenes: " << e.what() << '\n';
    return 1;
  }
}
