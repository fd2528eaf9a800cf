#include "tools/roscell/shell/builtins/event_filter.hpp"

#include "tools/roscell/client/event_text.hpp"
#include "tools/roscell/view/format.hpp"

#include <algorithm>

namespace roscell::cli {

namespace {

bool is_of_kind(const event& e, const std::string& kind) {
  return !kind.empty() && kind.back() == '*'
             ? e.what.compare(0, kind.size() - 1, kind, 0, kind.size() - 1) == 0
             : e.what == kind;
}

bool is_about(const event& e, const std::string& subject) {
  return e.subject == subject || event_text(e, "task") == subject
         || event_text(e, "node") == subject
         || event_text(e, "step") == subject;
}

} // namespace

bool event_filter::takes(const event& e) const {
  const auto fits = [&e](const auto& wanted, auto matches) {
    return wanted.empty()
           || std::any_of(wanted.begin(), wanted.end(),
                          [&](const auto& x) { return matches(e, x); });
  };
  return fits(kinds, is_of_kind) && fits(subjects, is_about);
}

std::string event_filter::words() const {
  auto result = kinds.empty() ? "all events" : joined(kinds, ", ");
  if (!subjects.empty())
    result += " of " + joined(subjects, ", ");
  return result;
}

} // namespace roscell::cli
