#include "roscell/ros2/image_encoding.hpp"
#include "skills/vision/brightness.hpp"

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <chrono>
#include <ctime>
#include <iostream>
#include <string>
#include <vector>

/// Times of what makes gray of YUV and Bayer beside those of cv::cvtColor on
/// the same pixels, on one core. The two take turns, so that both meet the same
/// state of the machine.
namespace {

using namespace roscell;
using nanoseconds = std::chrono::nanoseconds;

/// Time of this thread on a processor, whatever else the machine does.
nanoseconds processor_time() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return std::chrono::seconds{now.tv_sec} + nanoseconds{now.tv_nsec};
}

/// What OpenCV calls an encoding.
struct rival {
  const char* encoding;
  int type;   ///< Of its matrix.
  int thirds; ///< Rows of the matrix for two of the image.
  int code;
};

constexpr rival rivals[] = {
    {"yuv422_yuy2", CV_8UC2, 2, cv::COLOR_YUV2GRAY_YUY2},
    {"uyvy", CV_8UC2, 2, cv::COLOR_YUV2GRAY_UYVY},
    {"nv12", CV_8UC1, 3, cv::COLOR_YUV2GRAY_NV12},
    {"nv21", CV_8UC1, 3, cv::COLOR_YUV2GRAY_NV21},
    {"i420", CV_8UC1, 3, cv::COLOR_YUV2GRAY_I420},
    {"bayer_rggb8", CV_8UC1, 2, cv::COLOR_BayerBG2GRAY},
    {"bayer_bggr8", CV_8UC1, 2, cv::COLOR_BayerRG2GRAY},
    {"bayer_gbrg8", CV_8UC1, 2, cv::COLOR_BayerGR2GRAY},
    {"bayer_grbg8", CV_8UC1, 2, cv::COLOR_BayerGB2GRAY},
    {"bayer_rggb16", CV_16UC1, 2, cv::COLOR_BayerBG2GRAY},
    {"bayer_gbrg16", CV_16UC1, 2, cv::COLOR_BayerGR2GRAY},
};

double median_us(std::vector<nanoseconds> times) {
  const auto middle =
      times.begin() + static_cast<std::ptrdiff_t>(times.size() / 2);
  std::nth_element(times.begin(), middle, times.end());
  return std::chrono::duration<double, std::micro>{*middle}.count();
}

template <class Work>
void measure(std::vector<nanoseconds>& times, Work work) {
  const auto start = processor_time();
  work();
  times.push_back(processor_time() - start);
}

void run(const rival& other, int width, int height, unsigned rounds) {
  cv::Mat pixels(height * other.thirds / 2, width, other.type);
  cv::RNG random{7};
  random.fill(pixels, cv::RNG::UNIFORM, 0, other.type == CV_16UC1 ? 4096 : 256);
  ros2::image_view image;
  image.width = static_cast<std::uint32_t>(width);
  image.height = static_cast<std::uint32_t>(height);
  image.encoding = other.encoding;
  image.step = static_cast<std::uint32_t>(pixels.step);
  image.data = pixels.data;
  image.size = pixels.total() * pixels.elemSize();
  std::vector<std::uint8_t> buffer;
  cv::Mat gray;
  std::vector<nanoseconds> ours;
  std::vector<nanoseconds> theirs;
  for (auto i = 0U; i < rounds; ++i) {
    measure(ours, [&] { vision::to_gray(image, buffer); });
    measure(theirs, [&] { cv::cvtColor(pixels, gray, other.code); });
  }
  const auto own = median_us(ours);
  const auto opencv = median_us(theirs);
  std::cout << nlohmann::json{{"bench", "encoding_to_gray"},
                              {"encoding", other.encoding},
                              {"width", width},
                              {"height", height},
                              {"rounds", rounds},
                              {"own_median_us", own},
                              {"opencv_median_us", opencv},
                              {"ratio", own / opencv}}
            << std::endl;
}

} // namespace

int main(int argc, char** argv) {
  CLI::App app{
      "Time of vision::to_gray for YUV and Bayer beside cv::cvtColor's, "
      "on one core, as JSON lines."};
  auto width = 1920;
  auto height = 1080;
  auto rounds = 200U;
  app.option_defaults()->always_capture_default();
  app.add_option("--width", width, "Pixels in a row, even")
      ->check(CLI::Range(2, 16'000));
  app.add_option("--height", height, "Rows, even")
      ->check(CLI::Range(2, 16'000));
  app.add_option("--rounds", rounds, "How often each takes the image")
      ->check(CLI::Range(1, 100'000));
  CLI11_PARSE(app, argc, argv);
  cv::setNumThreads(1);
  for (const auto& other : rivals)
    run(other, width, height, rounds);
}
