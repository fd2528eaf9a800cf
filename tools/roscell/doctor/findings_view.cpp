#include "tools/roscell/doctor/findings_view.hpp"

#include "tools/roscell/doctor/command_text.hpp"
#include "tools/roscell/view/format.hpp"

#include <langinfo.h>

#include <algorithm>
#include <cctype>
#include <clocale>
#include <cstring>

namespace roscell::cli {

namespace {

std::string mark_of(judgement how, bool signs) {
  if (!signs)
    return to_word(how);
  switch (how) {
  case judgement::ok:
    return "✓";
  case judgement::skipped:
    return "-";
  case judgement::warning:
    return "!";
  default:
    return "✗";
  }
}

std::string heading_of(std::string area) {
  std::transform(area.begin(), area.end(), area.begin(), [](unsigned char c) {
    return static_cast<char>(std::toupper(c));
  });
  return area;
}

std::string area_view(const std::string& area, const findings& all,
                      const text_style& style, bool signs) {
  table t{{{"", align::left, always_shown, true},
           {heading_of(area), align::left, always_shown, true},
           {"SEEN", align::left, 1}},
          {}};
  for (const auto& x : all)
    if (x.area == area && x.node.empty())
      t.rows.push_back({mark_of(x.how, signs), x.check, x.seen});
  return t.render(style);
}

std::string remedy_of(const finding& x, const std::string& doctor) {
  return printable(x.remedy.size() <= longest_remedy
                       ? x.remedy
                       : remedies_of(doctor, x.check));
}

/// What is to be done, in lines that are not cut, so that they can be pasted.
std::string advice(const finding& x, const text_style& style, bool signs,
                   const std::string& doctor) {
  const auto mark = mark_of(x.how, signs);
  const auto colour = style.colour ? state_colour(mark) : "";
  std::string text = colour + mark + (colour.empty() ? "" : "\x1b[0m") + " "
                     + (x.node.empty() ? "" : printable(x.node) + ": ")
                     + printable(x.check) + ": " + printable(x.seen) + "\n";
  if (!x.matters.empty())
    text += "    " + printable(x.matters) + "\n";
  if (!x.remedy.empty())
    text += "    $ " + remedy_of(x, doctor) + "\n";
  return text;
}

using found_count = findings::difference_type;

found_count count_of(const findings& all, judgement how,
                     const std::string* node = nullptr) {
  return std::count_if(all.begin(), all.end(), [&](auto& x) {
    return x.how == how && (node == nullptr || x.node == *node);
  });
}

/// What other nodes have found on their hosts, in numbers: there are many.
std::string hosts_view(const findings& all, const text_style& style) {
  table t{{{"HOST"},
           {"BROKEN", align::right},
           {"WARNINGS", align::right},
           {"SKIPPED", align::right},
           {"OK", align::right}},
          {}};
  std::vector<std::string> nodes;
  for (const auto& x : all)
    if (!x.node.empty()
        && std::find(nodes.begin(), nodes.end(), x.node) == nodes.end())
      nodes.push_back(x.node);
  for (const auto& node : nodes) {
    t.rows.push_back({node});
    for (const auto how : {judgement::broken, judgement::warning,
                           judgement::skipped, judgement::ok})
      t.rows.back().push_back(std::to_string(count_of(all, how, &node)));
  }
  return nodes.empty() ? "" : t.render(style) + "\n";
}

std::string sum_of(const findings& all) {
  const auto broken = count_of(all, judgement::broken);
  const auto warnings = count_of(all, judgement::warning);
  if (broken == 0 && warnings == 0)
    return "nothing is wrong\n";
  return std::to_string(broken) + " broken, " + std::to_string(warnings)
         + (warnings == 1 ? " warning\n" : " warnings\n");
}

} // namespace

bool locale_is_utf8() {
  auto* locale = newlocale(LC_CTYPE_MASK, "", nullptr);
  if (locale == nullptr)
    return false;
  const bool result = std::strcmp(nl_langinfo_l(CODESET, locale), "UTF-8") == 0;
  freelocale(locale);
  return result;
}

std::string findings_view(const findings& all, const text_style& style,
                          bool signs, const std::string& doctor) {
  std::vector<std::string> areas;
  for (const auto& x : all)
    if (x.node.empty()
        && std::find(areas.begin(), areas.end(), x.area) == areas.end())
      areas.push_back(x.area);
  std::string text;
  for (const auto& area : areas)
    text += area_view(area, all, style, signs) + "\n";
  text += hosts_view(all, style);
  for (const auto how :
       {judgement::broken, judgement::warning, judgement::skipped})
    for (const auto& x : all)
      if (x.how == how && !(x.matters.empty() && x.remedy.empty()))
        text += advice(x, style, signs, doctor) + "\n";
  return text + sum_of(all);
}

std::string checks_view(const std::vector<check>& all,
                        const text_style& style) {
  table t{{{"CHECK"}, {"AREA"}, {"CHECKS WHETHER, OR", align::left, 1}}, {}};
  for (const auto& x : all)
    t.rows.push_back({x.name, x.area, x.about});
  return t.render(style);
}

} // namespace roscell::cli
