#include "actors/instances/skills/skill_catalogue.hpp"

#include "actors/core/clocks.hpp"
#include "actors/edge/disk/folder_hash.hpp"
#include "actors/instances/limits.hpp"
#include "messages/event_kinds.hpp"
#include "schemas/utf8.hpp"

#include <algorithm>
#include <utility>
#include <variant>

/// What a catalogue has that an earlier one had not.
namespace roscell {

namespace fs = std::filesystem;

namespace {

bool holds(const std::vector<skill_problem>& list, const skill_problem& x) {
  return std::find(list.begin(), list.end(), x) != list.end();
}

} // namespace

skill_catalogue skill_catalogue::scan_again(const std::vector<fs::path>& dirs,
                                            bool is_quiet) const {
  skill_catalogue result;
  result.host_ = host_;
  for (const auto& [hash, x] : skills_)
    if (x->in_process)
      result.skills_.emplace(hash, x);
  result.before_ = this;
  if (!is_quiet)
    result.too_new_unix_ms_ = unix_now_ms() - limits::skill::quiet.count();
  for (const auto& x : dirs)
    result.scan_directory(x);
  if (!is_quiet)
    result.drop_new_problems();
  result.before_ = nullptr;
  return result;
}

bool skill_catalogue::leave_as_before(const fs::path& path) {
  if (before_ == nullptr)
    return false;
  const auto look = read_folder(path);
  const auto* now = std::get_if<folder_fingerprint>(&look);
  if (now == nullptr)
    return false;
  const bool is_too_new = now->changed_unix_ms >= too_new_unix_ms_;
  const auto known = before_->folders_.find(path);
  if (known != before_->folders_.end()
      && (is_too_new || now->state == known->second->look)) {
    keep(known->second);
    return true;
  }
  return is_too_new;
}

void skill_catalogue::drop_new_problems() {
  const auto is_new = [this](const auto& x) {
    return !holds(before_->problems_, x);
  };
  problems_.erase(std::remove_if(problems_.begin(), problems_.end(), is_new),
                  problems_.end());
}

std::vector<skill_problem> skill_catalogue::published_problems() const {
  std::vector<skill_problem> result;
  for (size_t i = 0;
       i < std::min(problems_.size(), limits::skill::published_problems); ++i) {
    auto x = problems_[i];
    for (auto* text : {&x.path, &x.where, &x.message})
      *text = valid_utf8(text->substr(0, limits::skill::reported_text_bytes));
    result.push_back(std::move(x));
  }
  return result;
}

void skill_catalogue::publish_problems(const actor_context& context,
                                       const skill_catalogue& before) const {
  for (const auto& x : problems_)
    if (!holds(before.problems_, x))
      context.publish_event(events::skill_refused, x.path,
                            {{"where", x.where}, {"message", x.message}});
}

} // namespace roscell
