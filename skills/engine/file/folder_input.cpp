#include "skills/engine/file/folder_input.hpp"

#include "roscell/skill/errors.hpp"

#include <dirent.h>
#include <sys/inotify.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <iterator>
#include <memory>
#include <unordered_set>

namespace roscell::engine {

namespace {

/// Names that begin with a dot belong to files that are still being written,
/// by folder_output among others.
bool is_hidden(const std::string& name) {
  return name.empty() || name.front() == '.';
}

/// What people and tools put beside images: calibrations, licences, truths.
bool is_description(const std::string& name) {
  auto dot = name.find_last_of('.');
  if (dot == std::string::npos)
    return false;
  auto extension = name.substr(dot);
  constexpr const char* known[] = {".json", ".yaml", ".yml", ".txt", ".md"};
  return std::find(std::begin(known), std::end(known), extension)
         != std::end(known);
}

bool is_image_type(const std::string& data_type) {
  return data_type.compare(0, 6, "image/") == 0;
}

struct folder_closer {
  void operator()(DIR* folder) const {
    ::closedir(folder);
  }
};

} // namespace

folder_input::folder_input(const stream_context& input)
    : path_(input.config.endpoint), options_(read_file_options(input.options)),
      images_only_(is_image_type(input.config.data_type)), say_(input.say),
      pacer_(options_.rate_hz) {
  // nop
}

void folder_input::open() {
  if (::access(path_.c_str(), R_OK | X_OK) != 0)
    throw start_error("cannot read input folder '" + path_ + "': "
                      + std::strerror(errno) + "; correct its permissions");
  if (!options_.follow)
    return;
  changes_.emplace(say_);
  constexpr auto coming = IN_MOVED_TO | IN_CLOSE_WRITE;
  constexpr auto going = IN_MOVED_FROM | IN_DELETE;
  constexpr auto lost = IN_DELETE_SELF | IN_MOVE_SELF;
  if (changes_->add(path_, coming | going | lost) < 0)
    throw start_error("cannot follow input folder '" + path_
                      + "': " + std::strerror(errno)
                      + "; raise fs.inotify.max_user_watches, or set the "
                        "parameter 'follow' to false");
}

void folder_input::run(frame_sink& sink, const stop_event& stop) {
  if (!push_all(sink, stop))
    return;
  if (done_.empty())
    say_("input folder '" + path_ + "' is empty"
         + (options_.follow ? "; waiting for files" : ""));
  while (options_.loop ? begin_again(sink, stop)
                       : options_.follow && follow(sink, stop)) {
    // Each turn reads the folder again, or handles the events that came in.
  }
}

bool folder_input::begin_again(frame_sink& sink, const stop_event& stop) {
  if (done_.empty())
    return options_.follow && follow(sink, stop);
  done_.clear();
  return push_all(sink, stop) && !stop.is_set();
}

std::vector<std::string> folder_input::list() const {
  std::unique_ptr<DIR, folder_closer> folder{::opendir(path_.c_str())};
  if (!folder)
    throw stream_error("cannot list folder '" + path_
                       + "': " + std::strerror(errno));
  std::vector<std::string> names;
  while (const auto* entry = ::readdir(folder.get()))
    if (!is_left_out(entry->d_name))
      names.emplace_back(entry->d_name);
  std::sort(names.begin(), names.end());
  return names;
}

bool folder_input::is_left_out(const std::string& name) const {
  return is_hidden(name) || (images_only_ && is_description(name));
}

bool folder_input::push_all(frame_sink& sink, const stop_event& stop) {
  auto names = list();
  std::unordered_set<std::string> present{names.begin(), names.end()};
  for (auto i = done_.begin(); i != done_.end();)
    i = present.count(i->first) != 0 ? std::next(i) : done_.erase(i);
  return std::all_of(names.begin(), names.end(), [&](const auto& name) {
    return push_file(name, sink, stop);
  });
}

bool folder_input::push_file(const std::string& name, frame_sink& sink,
                             const stop_event& stop) {
  auto path = path_ + (path_.back() == '/' ? "" : "/") + name;
  auto known = done_.find(name);
  struct stat info {};
  if (::stat(path.c_str(), &info) == 0
      && ((known != done_.end() && known->second == file_identity::of(info))
          || (changes_ && changes_->may_be_unfinished(info))))
    return !stop.is_set();
  auto file = read_whole_file(path, options_.max_frame_bytes, say_);
  if (!file)
    return !stop.is_set();
  done_[name] = file->identity;
  return pacer_.wait(stop)
         && sink.push(std::move(file->content), when_full::wait);
}

bool folder_input::follow(frame_sink& sink, const stop_event& stop) {
  if (!stop.wait_readable(changes_->fd()))
    return false;
  auto events = changes_->read();
  return std::all_of(events.begin(), events.end(),
                     [&](const auto& e) { return on_event(e, sink, stop); });
}

bool folder_input::on_event(const inotify_watch::event& e, frame_sink& sink,
                            const stop_event& stop) {
  constexpr auto lost = IN_DELETE_SELF | IN_MOVE_SELF | IN_UNMOUNT | IN_IGNORED;
  if ((e.mask & lost) != 0)
    throw stream_error("input folder '" + path_ + "' was taken away");
  // The kernel lost events, because the executor is far behind, or there are
  // none to be had.
  if ((e.mask & IN_Q_OVERFLOW) != 0)
    return push_all(sink, stop);
  if (is_left_out(e.name))
    return true;
  if ((e.mask & (IN_MOVED_FROM | IN_DELETE)) != 0) {
    done_.erase(e.name);
    return true;
  }
  return push_file(e.name, sink, stop);
}

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
