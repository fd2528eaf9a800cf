#include "skills/engine/file/line_input.hpp"

#include "roscell/skill/errors.hpp"

#include <fcntl.h>
#include <sys/inotify.h>

#include <cerrno>
#include <cstring>

namespace roscell::engine {

line_input::line_input(const stream_context& input)
    : path_(input.config.endpoint), options_(read_file_options(input.options)),
      say_(input.say), splitter_(options_.max_frame_bytes),
      pacer_(options_.rate_hz) {
  // nop
}

void line_input::open() {
  if (options_.follow) {
    changes_.emplace(say_);
    // A replacement shows in the folder only. If the folder may not be read,
    // growth can still be followed.
    changes_->add(parent_folder(path_), IN_MOVED_TO | IN_CREATE);
  }
  if (!open_file())
    throw start_error("cannot read input '" + path_ + "': "
                      + std::strerror(errno) + "; correct its permissions");
}

void line_input::run(frame_sink& sink, const stop_event& stop) {
  if (!push_lines(sink, stop))
    return;
  while (options_.follow) {
    say_if_held_back();
    if (!stop.wait_readable(changes_->fd()) || !on_change(sink, stop))
      return;
  }
  push_rest(sink, stop);
}

/// Keeps the file that is open when there is no other to take its place. The
/// watch is set before the first read, so that no growth is missed.
bool line_input::open_file() {
  unique_fd found{::open(path_.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC)};
  if (!found)
    return false;
  file_ = std::move(found);
  offset_ = 0;
  if (options_.follow)
    watch_file();
  return true;
}

void line_input::watch_file() {
  changes_->remove(file_watch_);
  file_watch_ = changes_->add(path_, IN_MODIFY | IN_CLOSE_WRITE);
  if (file_watch_ < 0)
    throw stream_error("cannot follow '" + path_ + "': " + std::strerror(errno)
                       + "; raise fs.inotify.max_user_watches, or set the "
                         "parameter 'follow' to false");
}

bool line_input::push(frame_sink& sink, const stop_event& stop,
                      std::string line) {
  frame result;
  result.payload = std::move(line);
  result.name =
      base_name(path_) + ":" + std::to_string(splitter_.line_number());
  result.time = std::chrono::system_clock::now();
  return pacer_.wait(stop) && sink.push(std::move(result), when_full::wait);
}

/// Pushes the complete lines up to the current end of the file.
bool line_input::push_lines(frame_sink& sink, const stop_event& stop) {
  char buffer[65536];
  for (;;) {
    while (auto line = splitter_.next())
      if (!push(sink, stop, std::move(*line)))
        return false;
    say_if_too_long();
    auto n = ::pread(file_.get(), buffer, sizeof(buffer), offset_);
    if (n < 0 && errno != EINTR)
      throw stream_error("cannot read '" + path_
                         + "': " + std::strerror(errno));
    if (n == 0)
      return !stop.is_set();
    if (n > 0) {
      offset_ += n;
      splitter_.feed({buffer, static_cast<std::size_t>(n)});
    }
  }
}

bool line_input::push_rest(frame_sink& sink, const stop_event& stop) {
  auto line = splitter_.rest();
  say_if_too_long();
  return !line || push(sink, stop, std::move(*line));
}

bool line_input::push_all(frame_sink& sink, const stop_event& stop) {
  return push_lines(sink, stop) && push_rest(sink, stop);
}

bool line_input::on_change(frame_sink& sink, const stop_event& stop) {
  auto closed = false;
  for (const auto& e : changes_->read())
    closed =
        closed || (e.watch == file_watch_ && (e.mask & IN_CLOSE_WRITE) != 0);
  if (was_truncated()) {
    if (!push_rest(sink, stop))
      return false;
    offset_ = 0;
  }
  if (!(closed ? push_all(sink, stop) : push_lines(sink, stop)))
    return false;
  while (was_replaced()) {
    if (!push_all(sink, stop))
      return false;
    if (!open_file()) {
      // Gone again: its successor makes itself known by another event.
      if (errno == ENOENT)
        return true;
      throw stream_error("cannot read the new '" + path_
                         + "': " + std::strerror(errno));
    }
    if (!push_lines(sink, stop))
      return false;
  }
  return true;
}

bool line_input::was_truncated() const {
  struct stat now {};
  return ::fstat(file_.get(), &now) == 0 && now.st_size < offset_;
}

/// Whether another file is found at the path. While there is none, the old
/// one is kept: its writer may still hold it.
bool line_input::was_replaced() const {
  struct stat held {};
  struct stat found {};
  return ::fstat(file_.get(), &held) == 0 && ::stat(path_.c_str(), &found) == 0
         && (held.st_ino != found.st_ino || held.st_dev != found.st_dev);
}

void line_input::say_if_too_long() {
  if (splitter_.too_long() == too_long_said_)
    return;
  too_long_said_ = splitter_.too_long();
  say_("skipped " + std::to_string(too_long_said_) + " lines of '" + path_
       + "' so far: longer than " + std::to_string(options_.max_frame_bytes)
       + " bytes; see parameter 'max_frame_mib'");
}

void line_input::say_if_held_back() {
  if (held_back_said_ || !splitter_.has_rest())
    return;
  held_back_said_ = true;
  say_("the last line of '" + path_
       + "' has no newline yet and is held back until it has one or its "
         "writer closes the file");
}

void line_splitter::feed(std::string_view bytes) {
  buffer_.erase(0, position_);
  searched_ -= position_;
  position_ = 0;
  // The head of a line that is already too long is not needed any more.
  if (buffer_.size() > max_bytes_) {
    buffer_.clear();
    searched_ = 0;
    skipping_ = true;
  }
  buffer_ += bytes;
}

std::optional<std::string> line_splitter::next() {
  for (;;) {
    auto end = buffer_.find('\n', searched_);
    if (end == std::string::npos) {
      searched_ = buffer_.size();
      return std::nullopt;
    }
    auto start = position_;
    position_ = searched_ = end + 1;
    if (accept(end - start))
      return buffer_.substr(start, end - start);
  }
}

std::optional<std::string> line_splitter::rest() {
  if (!has_rest())
    return std::nullopt;
  auto start = position_;
  position_ = searched_ = buffer_.size();
  if (!accept(buffer_.size() - start))
    return std::nullopt;
  return buffer_.substr(start);
}

bool line_splitter::accept(std::size_t size) {
  ++lines_;
  auto fits = !skipping_ && size <= max_bytes_;
  skipping_ = false;
  if (!fits)
    ++too_long_;
  return fits;
}

} // namespace roscell::engine
