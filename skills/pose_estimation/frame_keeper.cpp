#include "skills/pose_estimation/frame_keeper.hpp"

#include <algorithm>
#include <iterator>

namespace roscell::pose {

namespace {

constexpr std::chrono::seconds out_of_view{1};

} // namespace

bool frame_keeper::may_send(std::size_t tree, const std::string& frame,
                            std::size_t source, const std::string& camera,
                            clock::time_point now) {
  if (owners_.size() >= forget_at_)
    forget_out_of_view(now);
  auto& last = owners_[{tree, frame}];
  if (last.camera.empty() || last.source == source
      || now - last.seen > out_of_view) {
    last = {source, camera, now};
    return true;
  }
  say_once("'" + camera + "' and '" + last.camera + "' both see '" + frame
           + "'; TF gets it of the one that saw it first: give each camera a "
             "prefix of its own by the parameter 'tag_prefixes'");
  return false;
}

void frame_keeper::forget_out_of_view(clock::time_point now) {
  for (auto i = owners_.begin(); i != owners_.end();)
    i = now - i->second.seen > out_of_view ? owners_.erase(i) : std::next(i);
  // With so many in view it need not be looked at again soon.
  forget_at_ = std::max(most_frames, 2 * owners_.size());
}

void frame_keeper::refuse_twins(const std::string& frame,
                                const std::string& camera) {
  say_once("'" + camera + "' sees '" + frame
           + "' more than once, so that TF gets it not at all; use each tag "
             "once");
}

void frame_keeper::say_once(const std::string& line) {
  // Bounds the memory; after that many lines one more does not matter.
  constexpr std::size_t most_lines = 1000;
  if (said_.size() >= most_lines)
    said_.clear();
  if (said_.insert(line).second)
    say_(line);
}

} // namespace roscell::pose
