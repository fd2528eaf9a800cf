#include "tools/roscell/view/describe/describe_view.hpp"

#include "tools/roscell/view/describe/page.hpp"
#include "tools/roscell/view/describe/things.hpp"
#include "tools/roscell/view/event_text.hpp"
#include "tools/roscell/view/format.hpp"
#include "tools/roscell/view/shape/shape.hpp"

#include <algorithm>
#include <set>

namespace roscell::cli {

namespace {

constexpr size_t shown_events = 10;

/// Which member of an event's particulars names a thing of that kind.
const char* member_of(thing_kind kind) {
  switch (kind) {
  case thing_kind::node:
    return "node";
  case thing_kind::task:
    return "task";
  case thing_kind::cell:
    return "cell";
  case thing_kind::instance:
  case thing_kind::skill:
    break;
  }
  return "";
}

} // namespace

std::vector<event> events_of(const known_cell& known, const known_thing& what) {
  std::vector<event> result;
  for (const auto& e : known.events)
    if ((e.subject == what.name
         || event_text(e, member_of(what.kind)) == what.name)
        && !is_on_the_way(e, known.asked.role))
      result.push_back(e);
  if (result.size() > shown_events)
    result.erase(result.begin(),
                 result.end() - static_cast<long>(shown_events));
  return result;
}

std::string describe_view(const known_cell& known, const known_thing& what,
                          const std::string& log, const view_style& style) {
  page out{style.text};
  out.detail("Kind", to_string(what.kind));
  out.detail("Name", what.name);
  switch (what.kind) {
  case thing_kind::node:
    describe_node(out, known, what.name, style);
    break;
  case thing_kind::task:
    describe_task(out, known, what.name, style);
    break;
  case thing_kind::instance:
    describe_instance(out, known, what.name, style);
    break;
  case thing_kind::skill:
    describe_skill(out, known, what.name, style);
    break;
  case thing_kind::cell:
    describe_cell(out, known, style);
    break;
  }
  out.section("Recent events", events_table(events_of(known, what), style));
  out.section("End of the log", printable_lines(log));
  return out.text();
}

json describe_json(const known_cell& known, const known_thing& what,
                   const std::string& log) {
  json events = json::array();
  for (const auto& e : events_of(known, what))
    events.push_back(message_json(e));
  json result{{"kind", to_string(what.kind)},
              {"name", what.name},
              {"about", shaped(json_of(known, what))},
              {"events", std::move(events)}};
  if (!log.empty())
    result["log"] = log;
  return result;
}

} // namespace roscell::cli
