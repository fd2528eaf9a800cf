#include "skills/engine/file/file_output.hpp"

#include "roscell/skill/errors.hpp"
#include "skills/engine/file/file_reading.hpp"
#include "skills/engine/life/unique_fd.hpp"

#include <fcntl.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
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

namespace {

/// Returns 0 or an errno.
int write_file(const std::string& path, const std::string& content) {
  unique_fd file{
      ::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644)};
  if (!file)
    return errno;
  std::size_t written = 0;
  while (written < content.size()) {
    auto n =
        ::write(file.get(), content.data() + written, content.size() - written);
    if (n > 0)
      written += static_cast<std::size_t>(n);
    else if (n == 0 || errno != EINTR)
      return n == 0 ? EIO : errno;
  }
  return 0;
}

} // namespace

std::string file_name_of(const frame& result) {
  // Leaves room for the dot and the ".tmp" of the temporary name in the 255
  // bytes that a name may have.
  constexpr std::size_t max_name_bytes = 250;
  auto name = result.name;
  if (name.size() > max_name_bytes)
    name.erase(0, name.size() - max_name_bytes);
  std::replace(name.begin(), name.end(), '/', '_');
  std::replace(name.begin(), name.end(), '\0', '_');
  if (name.empty())
    return std::to_string(result.sequence);
  if (name.front() == '.')
    name.front() = '_';
  return name;
}

folder_output::folder_output(const stream_context& output)
    : path_(output.config.endpoint) {
  if (path_.back() != '/')
    path_ += '/';
}

void folder_output::open() {
  make_folders(path_);
  if (::access(path_.c_str(), W_OK | X_OK) != 0)
    throw start_error("cannot write into output folder '" + path_
                      + "': " + std::strerror(errno)
                      + "; correct its permissions or the mount");
}

void folder_output::write(const frame& result) {
  auto name = file_name_of(result);
  auto temporary = path_ + "." + name + ".tmp";
  if (auto error = write_file(temporary, result.payload))
    fail(temporary, error);
  if (std::rename(temporary.c_str(), (path_ + name).c_str()) != 0)
    fail(temporary, errno);
}

void folder_output::close() {
  // Every file was closed when it was written.
}

void folder_output::fail(const std::string& temporary, int error) const {
  ::unlink(temporary.c_str());
  throw stream_error("cannot write into '" + path_
                     + "': " + std::strerror(error)
                     + (error == ENOSPC ? "; free space on that disk" : ""));
}

} // namespace roscell::engine
