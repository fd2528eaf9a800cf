#include "roscell/ros2/image_encoding.hpp"
#include "skills/vision/brightness.hpp"
#include "tools/bench/vision_modes.hpp"

#include <nlohmann/json.hpp>
#include <opencv2/imgproc.hpp>

#include <chrono>
#include <ctime>
#include <iostream>
#include <string>
#include <vector>

namespace roscell::bench {

namespace {

using nanoseconds = std::chrono::nanoseconds;

/// Time of this thread on a processor, whatever else the machine does.
nanoseconds processor_time() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return std::chrono::seconds{now.tv_sec} + nanoseconds{now.tv_nsec};
}

constexpr auto width = 1920;
constexpr auto height = 1080;

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

void compare_encoding(const rival& other, unsigned rounds) {
  cv::Mat pixels(height * other.thirds / 2, width, other.type);
  cv::RNG random{7};
  random.fill(pixels, cv::RNG::UNIFORM, 0, other.type == CV_16UC1 ? 4096 : 256);
  ros2::image_view image;
  image.width = width;
  image.height = height;
  image.encoding = other.encoding;
  image.step = static_cast<std::uint32_t>(pixels.step);
  image.data = pixels.data;
  image.size = pixels.total() * pixels.elemSize();
  std::vector<std::uint8_t> buffer;
  cv::Mat gray;
  std::vector<double> ours;
  std::vector<double> theirs;
  for (auto i = 0U; i < rounds; ++i) {
    measure(ours, processor_time, [&] { vision::to_gray(image, buffer); });
    measure(theirs, processor_time,
            [&] { cv::cvtColor(pixels, gray, other.code); });
  }
  const auto own = 1000 * quantile(ours, 0.5);
  const auto opencv = 1000 * quantile(theirs, 0.5);
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

void compare_times_of_encodings(unsigned rounds) {
  cv::setNumThreads(1);
  for (const auto& other : rivals)
    compare_encoding(other, rounds);
}

} // namespace roscell::bench
