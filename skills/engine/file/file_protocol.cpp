#include "skills/engine/file/file_protocol.hpp"

#include "roscell/skill/errors.hpp"
#include "skills/engine/file/file_output.hpp"
#include "skills/engine/file/folder_input.hpp"
#include "skills/engine/file/line_input.hpp"

#include <sys/stat.h>

#include <cerrno>
#include <cstring>

namespace roscell::engine {

namespace {

bool starts_with(const std::string& text, const std::string& prefix) {
  return text.compare(0, prefix.size(), prefix) == 0;
}

bool is_media_type(const std::string& data_type) {
  return starts_with(data_type, "image/") || starts_with(data_type, "video/")
         || starts_with(data_type, "audio/")
         || data_type == "application/octet-stream";
}

void check_path(const std::string& path) {
  if (path.empty() || path.front() != '/'
      || path.find('\0') != std::string::npos)
    throw start_error("file endpoint '" + path
                      + "' must be an absolute path; correct it in the step");
}

} // namespace

void add_file_protocol(registry& target) {
  target.add_input("file", make_file_input);
  target.add_output("file", make_file_output);
}

bool is_text_type(const std::string& data_type) {
  return starts_with(data_type, "text/") || data_type == "application/json"
         || data_type == "application/x-ndjson";
}

std::unique_ptr<input_handler> make_file_input(const stream_context& input) {
  const auto& path = input.config.endpoint;
  check_path(path);
  struct stat info {};
  if (::stat(path.c_str(), &info) != 0)
    throw start_error("cannot read input '" + path
                      + "': " + std::strerror(errno)
                      + "; it must be there, and mounted, on the node that "
                        "runs this step");
  if (S_ISDIR(info.st_mode))
    return std::make_unique<folder_input>(input);
  if (!S_ISREG(info.st_mode))
    throw start_error("input '" + path
                      + "' is neither a regular file nor a folder");
  if (is_text_type(input.config.data_type))
    return std::make_unique<line_input>(input);
  return std::make_unique<whole_file_input>(input);
}

std::unique_ptr<output_handler> make_file_output(const stream_context& output) {
  const auto& path = output.config.endpoint;
  check_path(path);
  struct stat info {};
  auto exists = ::stat(path.c_str(), &info) == 0;
  if (path.back() == '/' || (exists && S_ISDIR(info.st_mode)))
    return std::make_unique<folder_output>(output);
  if (exists && !S_ISREG(info.st_mode) && !S_ISCHR(info.st_mode))
    throw start_error("output '" + path
                      + "' is neither a regular file nor a folder");
  if (is_media_type(output.config.data_type))
    throw start_error("output '" + path + "' cannot hold frames of type '"
                      + output.config.data_type
                      + "' as lines; end the path with '/' to get a folder");
  return std::make_unique<line_output>(output);
}

} // namespace roscell::engine
