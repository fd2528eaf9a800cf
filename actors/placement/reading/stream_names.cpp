#include "actors/placement/reading/stream_names.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <string_view>
#include <utility>

namespace roscell {

namespace {

bool is_letter(char c) {
  return std::isalpha(static_cast<unsigned char>(c)) != 0 || c == '_';
}

bool is_word_character(char c) {
  return is_letter(c) || std::isdigit(static_cast<unsigned char>(c)) != 0;
}

bool begins_with(std::string_view text, std::string_view start) {
  return text.substr(0, start.size()) == start;
}

std::string last_segment(const std::string& text) {
  const auto end = text.find_last_not_of('/');
  if (end == std::string::npos)
    return {};
  const auto begin = text.rfind('/', end);
  return text.substr(begin + 1, end - begin);
}

std::string ending_of(const std::string& path) {
  const auto name = last_segment(path);
  const auto dot = name.rfind('.');
  return dot == std::string::npos || dot == 0 ? "" : name.substr(dot + 1);
}

/// `CameraInfo` as `camera_info`, `TFMessage` as `tf_message`.
std::string snake_case(const std::string& name) {
  std::string result;
  for (size_t i = 0; i < name.size(); ++i) {
    const auto c = static_cast<unsigned char>(name[i]);
    const auto next = i + 1 < name.size() ? name[i + 1] : 'A';
    const bool begins_word =
        std::isupper(c) != 0 && i > 0
        && (std::isupper(static_cast<unsigned char>(name[i - 1])) == 0
            || std::islower(static_cast<unsigned char>(next)) != 0);
    if (begins_word)
      result += '_';
    result += static_cast<char>(std::tolower(c));
  }
  return result;
}

std::string without_slash(std::string path) {
  while (path.size() > 1 && path.back() == '/')
    path.pop_back();
  return path;
}

} // namespace

std::string full_topic(const std::string& name) {
  return begins_with(name, "/") ? name : "/" + name;
}

bool is_topic(const std::string& text) {
  if (text.size() < 2 || text.front() != '/' || text.back() == '/')
    return false;
  for (size_t i = 1; i < text.size(); ++i) {
    const bool begins_word = text[i - 1] == '/';
    if (text[i] == '/' ? begins_word : !is_word_character(text[i]))
      return false;
    if (begins_word && !is_letter(text[i]))
      return false;
  }
  return true;
}

std::string topic_word(const std::string& text) {
  auto result = text;
  std::replace_if(
      result.begin(), result.end(),
      [](char c) { return !is_word_character(c); }, '_');
  return result.empty() || !is_letter(result.front()) ? "_" + result : result;
}

std::string type_name(const std::string& data_type) {
  constexpr std::string_view suffix = "_message";
  auto result = snake_case(last_segment(data_type));
  if (result.size() > suffix.size()
      && result.compare(result.size() - suffix.size(), suffix.size(), suffix)
             == 0)
    result.resize(result.size() - suffix.size());
  return result;
}

bool is_message_type(const std::string& data_type) {
  return data_type.find("/msg/") != std::string::npos;
}

std::string endpoint_name(const std::string& endpoint) {
  const auto name = last_segment(endpoint);
  return name.substr(0, std::max<size_t>(1, name.find('.')));
}

std::string type_of_file(const std::string& path) {
  static constexpr std::array<std::pair<const char*, const char*>, 6> types{
      {{"png", "image/png"},
       {"jpg", "image/jpeg"},
       {"jpeg", "image/jpeg"},
       {"json", "application/json"},
       {"jsonl", "application/json"},
       {"txt", "text/plain"}}};
  const auto ending = ending_of(path);
  for (const auto& [name, type] : types)
    if (ending == name)
      return type;
  return {};
}

bool is_device(const std::string& endpoint) {
  static constexpr std::array<std::string_view, 9> others{
      "/dev/fd/",    "/dev/full",   "/dev/null",    "/dev/random", "/dev/shm/",
      "/dev/stderr", "/dev/stdout", "/dev/urandom", "/dev/zero"};
  return begins_with(endpoint, "/dev/")
         && std::none_of(others.begin(), others.end(), [&](auto other) {
              return begins_with(endpoint, other);
            });
}

bool looks_like_file(const std::string& endpoint) {
  static constexpr std::array<std::string_view, 12> roots{
      "/data/", "/dev/",  "/etc/", "/home/", "/media/", "/mnt/",
      "/opt/",  "/root/", "/run/", "/srv/",  "/tmp/",   "/var/"};
  return begins_with(endpoint, "/")
         && (!is_topic(endpoint)
             || std::any_of(roots.begin(), roots.end(), [&](auto root) {
                  return begins_with(endpoint, root);
                }));
}

bool looks_like_video(const std::string& endpoint) {
  static constexpr std::array<std::string_view, 8> endings{
      "avi", "m4v", "mkv", "mov", "mp4", "mpg", "mpeg", "webm"};
  const auto ending = ending_of(endpoint);
  return begins_with(endpoint, "/dev/video")
         || endpoint.find("://") != std::string::npos
         || std::find(endings.begin(), endings.end(), ending) != endings.end();
}

bool overlap(const std::string& path, const std::string& other) {
  const auto x = without_slash(path);
  const auto y = without_slash(other);
  return x == y || begins_with(x, y + "/") || begins_with(y, x + "/");
}

} // namespace roscell
