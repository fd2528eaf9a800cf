#include "tools/compare_poses/reading.hpp"

#include <nlohmann/json.hpp>

#include <array>
#include <deque>
#include <fstream>
#include <stdexcept>

namespace roscell::comparison {

namespace {

using nlohmann::json;

struct numbered_line {
  std::size_t number;
  std::string text;
};

std::ifstream open_file(const std::string& path) {
  std::ifstream file{path, std::ios::binary};
  if (!file)
    throw std::runtime_error("cannot read '" + path + "'");
  return file;
}

pose to_pose(const json& document) {
  auto p = document.at("position").get<std::array<double, 3>>();
  auto q = document.at("orientation").get<std::array<double, 4>>();
  return {{p[0], p[1], p[2]},
          Eigen::Quaterniond{q[3], q[0], q[1], q[2]}.normalized()};
}

std::deque<numbered_line> last_lines(const std::string& path,
                                     std::size_t most) {
  auto file = open_file(path);
  std::deque<numbered_line> lines;
  std::string text;
  for (std::size_t number = 1; std::getline(file, text) && !file.eof();
       ++number) {
    lines.push_back({number, text});
    if (most > 0 && lines.size() > most)
      lines.pop_front();
  }
  return lines;
}

/// What frames tell of their times.
struct frame_times {
  std::vector<double> stamps_s;
  std::vector<double> ages_ms;
};

void add_frame(const json& frame, estimated_poses& poses, frame_times& times) {
  for (const auto& tag : frame.at("tags"))
    if (const auto& found = tag.at("pose"); !found.is_null())
      poses[tag.at("id").get<int>()].push_back(to_pose(found));
  if (frame.contains("stamp"))
    times.stamps_s.push_back(frame["stamp"].get<double>());
  if (frame.contains("age_ms"))
    times.ages_ms.push_back(frame["age_ms"].get<double>());
}

frame_timing timing_of(const frame_times& times) {
  frame_timing result;
  const auto& stamps = times.stamps_s;
  if (stamps.size() > 1 && stamps.back() > stamps.front())
    result.rate_hz = static_cast<double>(stamps.size() - 1)
                     / (stamps.back() - stamps.front());
  if (!times.ages_ms.empty())
    result.latency_ms = median(times.ages_ms);
  return result;
}

} // namespace

true_poses read_truth(const std::string& path) {
  auto file = open_file(path);
  true_poses result;
  try {
    const auto document = json::parse(file);
    for (const auto& tag : document.at("tags"))
      result.emplace(tag.at("id").get<int>(), to_pose(tag.at("pose")));
  } catch (const json::exception& e) {
    throw std::runtime_error("'" + path + "' is no truth.json: " + e.what());
  }
  return result;
}

estimates read_estimates(const std::string& path, std::size_t last_frames) {
  estimates result;
  frame_times times;
  for (const auto& line : last_lines(path, last_frames)) {
    try {
      add_frame(json::parse(line.text), result.poses, times);
    } catch (const json::exception& e) {
      throw std::runtime_error("'" + path + "', line "
                               + std::to_string(line.number)
                               + " is not from pose_estimation: " + e.what());
    }
  }
  result.timing = timing_of(times);
  return result;
}

} // namespace roscell::comparison
