#include "skills/engine/file/line_output.hpp"

#include "roscell/skill/errors.hpp"
#include "skills/engine/file/file_reading.hpp"

#include <fcntl.h>

#include <cerrno>
#include <cstring>
#include <filesystem>

namespace roscell::engine {

void make_folders(const std::string& path) {
  std::error_code error;
  std::filesystem::create_directories(path, error);
  if (error)
    throw start_error("cannot make output folder '" + path + "': "
                      + error.message() + "; correct the endpoint or mount it");
}

line_output::line_output(const stream_context& output)
    : path_(output.config.endpoint) {
  // nop
}

void line_output::open() {
  make_folders(parent_folder(path_));
  file_ = unique_fd{
      ::open(path_.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0644)};
  if (!file_)
    throw start_error("cannot write output '" + path_
                      + "': " + std::strerror(errno)
                      + "; correct its permissions or the mount");
}

void line_output::write(const frame& result) {
  auto line = result.payload;
  if (line.empty() || line.back() != '\n')
    line += '\n';
  std::size_t written = 0;
  while (written < line.size()) {
    auto n = ::write(file_.get(), line.data() + written, line.size() - written);
    if (n > 0)
      written += static_cast<std::size_t>(n);
    else if (n == 0 || errno != EINTR)
      fail(written, n == 0 ? EIO : errno);
  }
}

void line_output::close() {
  unique_fd closed;
  std::swap(closed, file_);
}

/// Takes back the part of a line that was written, so that whoever continues
/// the file later starts a line of its own.
void line_output::fail(std::size_t written, int error) {
  auto end = ::lseek(file_.get(), 0, SEEK_CUR);
  auto start = end - static_cast<off_t>(written);
  if (written > 0 && start >= 0 && ::ftruncate(file_.get(), start) != 0)
    error = errno;
  throw stream_error("cannot write '" + path_ + "': " + std::strerror(error)
                     + (error == ENOSPC ? "; free space on that disk" : ""));
}

} // namespace roscell::engine
