#include "actors/edge/process/skill_grants.hpp"

#include "actors/edge/process/privileges.hpp"

#include <algorithm>
#include <charconv>
#include <optional>
#include <string_view>

namespace roscell {

namespace {

using grant_sort = skill_grant::sort;

constexpr int64_t highest_priority = 99;
constexpr int64_t lowest_nice = -20;

/// Takes what comes before `end` off the text; all of it if there is none.
std::string_view take_word(std::string_view& text, char end) {
  const auto at = text.find(end);
  const auto result = text.substr(0, at);
  text.remove_prefix(at == std::string_view::npos ? text.size() : at + 1);
  return result;
}

std::optional<int64_t> number_in(std::string_view text, int64_t least,
                                 int64_t most) {
  int64_t result = 0;
  const auto* end = text.data() + text.size();
  const auto read = std::from_chars(text.data(), end, result);
  if (read.ec != std::errc{} || read.ptr != end || result < least
      || result > most)
    return std::nullopt;
  return result;
}

std::string quoted_word(std::string_view word) {
  return std::string{"'"}.append(word).append("'");
}

/// Sets what is granted by the words behind `scheduling:`, or says what is
/// wrong.
std::string read_scheduling(std::string_view text, skill_grant& to) {
  const auto policy = take_word(text, ':');
  std::optional<int64_t> bound;
  if (policy == "fifo" || policy == "rr") {
    to.what = policy == "fifo" ? grant_sort::fifo : grant_sort::rr;
    bound = number_in(text, 1, highest_priority);
    if (!bound)
      return quoted_word(text) + " is no priority from 1 to 99";
  } else if (policy == "nice") {
    to.what = grant_sort::nice;
    bound = number_in(text, lowest_nice, -1);
    if (!bound)
      return quoted_word(text)
             + " is no nice value from -20 to -1; higher ones"
               " need no grant";
  } else {
    return quoted_word(policy) + " is not fifo, rr or nice";
  }
  to.bound = *bound;
  return {};
}

std::string read_what(std::string_view text, skill_grant& to) {
  const auto whole = text;
  const auto kind = take_word(text, ':');
  if (kind == "scheduling")
    return read_scheduling(text, to);
  if (text.empty() || (kind != "capability" && kind != "user"))
    return quoted_word(whole)
           + " is not capability:NAME, user:NAME or scheduling:POLICY:BOUND";
  to.name = text;
  to.what = kind == "user" ? grant_sort::user : grant_sort::capability;
  if (to.what == grant_sort::capability && !capability_number(text))
    return "there is no capability " + quoted_word(text)
           + "; `man 7 capabilities` lists them, NET_RAW is one";
  return {};
}

std::string scheduling_what(const scheduling_request& request) {
  if (request.policy == "fifo" || request.policy == "rr")
    return "scheduling:" + request.policy + ":"
           + std::to_string(request.priority);
  return "scheduling:nice:" + std::to_string(request.nice);
}

} // namespace

std::variant<skill_grants, std::string>
skill_grants::parse(const std::vector<std::string>& lines) {
  skill_grants result;
  for (const auto& line : lines) {
    std::string_view rest = line;
    const auto skill = take_word(rest, '=');
    if (skill.empty() || rest.empty())
      return quoted_word(line) + " is not SKILL=WHAT[,WHAT...]";
    while (!rest.empty()) {
      skill_grant grant;
      grant.skill = skill;
      if (auto why = read_what(take_word(rest, ','), grant); !why.empty())
        return why;
      result.grants_.push_back(std::move(grant));
    }
  }
  return result;
}

bool skill_grants::allows_capability(const std::string& skill,
                                     const std::string& name) const {
  return std::any_of(grants_.begin(), grants_.end(), [&](const auto& x) {
    return x.what == grant_sort::capability && x.name == name
           && (x.skill == skill || x.skill == "*");
  });
}

std::string skill_grants::user_of(const std::string& skill) const {
  std::string result;
  for (const auto& x : grants_)
    if (x.what == grant_sort::user
        && (x.skill == skill || (x.skill == "*" && result.empty())))
      result = x.name;
  return result;
}

bool skill_grants::allows_scheduling(const std::string& skill,
                                     const scheduling_request& request) const {
  const bool real_time = request.policy == "fifo" || request.policy == "rr";
  if (!real_time && request.nice >= 0)
    return true;
  return std::any_of(grants_.begin(), grants_.end(), [&](const auto& x) {
    if (x.skill != skill && x.skill != "*")
      return false;
    if (!real_time)
      return x.what == grant_sort::nice && x.bound <= request.nice;
    const auto sort =
        request.policy == "fifo" ? grant_sort::fifo : grant_sort::rr;
    return x.what == sort && request.priority <= x.bound;
  });
}

std::vector<std::string>
skill_grants::missing(const std::string& skill,
                      const deployment_option& wanted) const {
  std::vector<std::string> result;
  for (const auto& x : wanted.capabilities)
    if (!allows_capability(skill, x))
      result.push_back("capability:" + x);
  if (!allows_scheduling(skill, wanted.scheduling))
    result.push_back(scheduling_what(wanted.scheduling));
  return result;
}

std::string refusal_text(const std::string& skill, const std::string& node,
                         const std::string& what) {
  auto wanted = what;
  std::replace(wanted.begin(), wanted.end(), ':', ' ');
  return "skill '" + skill + "' wants " + wanted + ", which node '" + node
         + "' does not grant it: grant = " + skill + "=" + what;
}

} // namespace roscell
