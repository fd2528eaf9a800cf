#include "tools/render_scenes/picture.hpp"

#include <CLI/CLI.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <iostream>

/// Draws a tag of each family with what `tag_size_m` means of it.
namespace {

using roscell::scenes::tag_sheet;

constexpr auto sheet_px = 198; ///< Across the whole of a tag.
constexpr auto columns = 3;
const cv::Size field{260, 300}; ///< Of one family.
const cv::Point sheet_at{31, 20};
const cv::Scalar black{0, 0, 0};
const cv::Scalar ground{235, 235, 235}; ///< So that white margins are seen.
const cv::Scalar magenta{200, 0, 200};

void write_text(cv::Mat& target, const std::string& text, int y,
                const cv::Scalar& ink) {
  constexpr auto scale = 0.5;
  auto base = 0;
  const auto size =
      cv::getTextSize(text, cv::FONT_HERSHEY_SIMPLEX, scale, 1, &base);
  cv::putText(target, text, {(target.cols - size.width) / 2, y},
              cv::FONT_HERSHEY_SIMPLEX, scale, ink, 1, cv::LINE_AA);
}

void draw_tag(cv::Mat& target, const tag_sheet& sheet) {
  const auto pixels_of_size = static_cast<double>(sheet_px)
                              * sheet.border_cells() / sheet.sheet_cells();
  for (auto y = 0; y < sheet_px; ++y)
    for (auto x = 0; x < sheet_px; ++x) {
      const auto shade =
          sheet.shade(0, (x + 0.5 - sheet_px / 2.0) / pixels_of_size,
                      (sheet_px / 2.0 - y - 0.5) / pixels_of_size);
      target.at<cv::Vec3b>(sheet_at.y + y, sheet_at.x + x) =
          shade == 0 ? cv::Vec3b{0, 0, 0} : cv::Vec3b{255, 255, 255};
    }
  const auto margin = cvRound((sheet_px - pixels_of_size) / 2);
  const auto side = cvRound(pixels_of_size);
  const cv::Rect square{sheet_at.x + margin, sheet_at.y + margin, side, side};
  cv::rectangle(target, square, magenta, 2);
  // What is measured, below the tag.
  const auto y = sheet_at.y + sheet_px + 12;
  cv::arrowedLine(target, {square.x, y}, {square.x + side, y}, magenta, 2,
                  cv::LINE_AA, 0, 0.06);
  cv::arrowedLine(target, {square.x + side, y}, {square.x, y}, magenta, 2,
                  cv::LINE_AA, 0, 0.06);
}

cv::Mat draw_family(const std::string& name) {
  const tag_sheet sheet{name, 1};
  cv::Mat result(field, CV_8UC3, ground);
  draw_tag(result, sheet);
  write_text(result, name, sheet_at.y + sheet_px + 36, black);
  write_text(result,
             "tag_size_m: " + std::to_string(sheet.border_cells()) + " of "
                 + std::to_string(sheet.sheet_cells()) + " cells",
             sheet_at.y + sheet_px + 58, magenta);
  return result;
}

cv::Mat draw_all() {
  const auto names = roscell::scenes::family_names();
  const auto rows = (static_cast<int>(names.size()) + columns - 1) / columns;
  cv::Mat result(rows * field.height, columns * field.width, CV_8UC3, ground);
  for (std::size_t i = 0; i < names.size(); ++i) {
    const cv::Point at{static_cast<int>(i) % columns * field.width,
                       static_cast<int>(i) / columns * field.height};
    draw_family(names[i]).copyTo(result(cv::Rect{at, field}));
  }
  return result;
}

} // namespace

int main(int argc, char** argv) {
  CLI::App app{
      "Draws the first tag of each AprilTag family, and which square of "
      "it the parameter\ntag_size_m measures."};
  std::string path;
  app.add_option("FILE", path, "Where the picture goes, a .png")->required();
  CLI11_PARSE(app, argc, argv);
  try {
    if (cv::imwrite(path, draw_all()))
      return 0;
    std::cerr << "draw_families: cannot write '" << path << "'\n";
  } catch (const std::exception& e) {
    std::cerr << "draw_families: " << e.what() << '\n';
  }
  return 1;
}
