#include "skills/engine/file/whole_file_input.hpp"

#include "roscell/skill/errors.hpp"

#include <sys/inotify.h>

#include <cerrno>
#include <cstring>

namespace roscell::engine {

whole_file_input::whole_file_input(const stream_context& input)
    : path_(input.config.endpoint), options_(read_file_options(input.options)),
      say_(input.say), pacer_(options_.rate_hz) {
  // nop
}

void whole_file_input::open() {
  if (::access(path_.c_str(), R_OK) != 0)
    throw start_error("cannot read input '" + path_ + "': "
                      + std::strerror(errno) + "; correct its permissions");
  if (!options_.follow)
    return;
  changes_.emplace(say_);
  // A replacement shows in the folder only. If the folder may not be read,
  // the file itself can still be followed.
  changes_->add(parent_folder(path_), IN_MOVED_TO | IN_CLOSE_WRITE);
  watch_file();
}

void whole_file_input::run(frame_sink& sink, const stop_event& stop) {
  if (!push_if_new(sink, stop))
    return;
  while (options_.follow && stop.wait_readable(changes_->fd())) {
    auto concerned = false;
    for (const auto& e : changes_->read())
      concerned = concerned || concerns_file(e);
    if (!concerned)
      continue;
    watch_file();
    if (!push_if_new(sink, stop))
      return;
  }
}

/// The file itself is watched as well as its folder: where only the file is
/// mounted into a container, the folder inside sees no changes.
void whole_file_input::watch_file() {
  auto old = file_watch_;
  file_watch_ = changes_->add(path_, IN_CLOSE_WRITE);
  if (old != file_watch_)
    changes_->remove(old);
}

bool whole_file_input::push_if_new(frame_sink& sink, const stop_event& stop) {
  struct stat info {};
  if (::stat(path_.c_str(), &info) == 0
      && (file_identity::of(info) == last_
          || (changes_ && changes_->may_be_unfinished(info))))
    return !stop.is_set();
  auto file = read_whole_file(path_, options_.max_frame_bytes, say_);
  if (!file || file->identity == last_)
    return !stop.is_set();
  last_ = file->identity;
  return pacer_.wait(stop)
         && sink.push(std::move(file->content), when_full::wait);
}

bool whole_file_input::concerns_file(const inotify_watch::event& e) const {
  if ((e.mask & IN_Q_OVERFLOW) != 0)
    return true;
  return e.watch == file_watch_ || e.name == base_name(path_);
}

} // namespace roscell::engine
