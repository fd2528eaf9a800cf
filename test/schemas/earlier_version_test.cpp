#include "schemas/schema_list.hpp"
#include "test/places.hpp"
#include "test/schemas/examples.hpp"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <limits>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

/// A cell may have nodes of this version and of an earlier one for as long as
/// an upgrade takes. Whatever a message may say, the other version has to take
/// it.
namespace {

using namespace roscell;
using nlohmann::json;

using schema_set = std::map<std::string, json>;

schema_set present_schemas() {
  schema_set result;
  for (const auto& x : all_schemas())
    result[std::string{x.name}] = x.document();
  return result;
}

/// Those of commit 7566a8a, without words for people.
schema_set earlier_schemas() {
  return json::parse(
             test::read_file(test::source_dir() / "test/data/version_7566a8a"
                             / "schemas.json"))
      .get<schema_set>();
}

/// A subschema, and where the references in it lead.
struct rule_place {
  const schema_set* all;
  std::string document;
  const json* rule;

  rule_place operator()(const json& part) const {
    return rule_place{all, document, &part}.resolved();
  }

  /// That to which it refers, if it does.
  rule_place resolved() const {
    const auto reference = rule->find("$ref");
    if (reference == rule->end())
      return *this;
    const auto text = reference->get<std::string>();
    const auto hash = std::min(text.find('#'), text.size());
    const auto path = text.substr(0, hash);
    const auto file = path.substr(0, path.find('.'));
    const auto& target = file.empty() ? document : file;
    const auto& root = all->at(target);
    const json::json_pointer inside{
        hash == text.size() ? std::string{} : text.substr(hash + 1)};
    return rule_place{all, target, &root.at(inside)}.resolved();
  }

  std::vector<rule_place> choices() const {
    if (!rule->contains("oneOf"))
      return {*this};
    std::vector<rule_place> result;
    for (const auto& x : (*rule)["oneOf"])
      result.push_back((*this)(x));
    return result;
  }
};

std::set<std::string> strings_in(const json& x) {
  return x.is_array() ? x.get<std::set<std::string>>()
                      : std::set<std::string>{x.get<std::string>()};
}

/// The only words that a value may be; empty: it may be any.
std::set<std::string> allowed_words(const json& rule) {
  for (const auto* key : {"enum", "const"})
    if (rule.contains(key))
      return strings_in(rule[key]);
  return {};
}

/// The kinds of values; empty: all.
std::set<std::string> kinds_of(const json& rule) {
  if (!allowed_words(rule).empty() || rule.contains("pattern"))
    return {"string"};
  auto result = strings_in(rule.value("type", json::array()));
  if (result.count("number") != 0)
    result.insert("integer");
  return result;
}

/// Whether what is one of `some` is one of `all`. An empty set is everything.
bool is_within(const std::set<std::string>& some,
               const std::set<std::string>& all) {
  return all.empty()
         || (!some.empty()
             && std::includes(all.begin(), all.end(), some.begin(),
                              some.end()));
}

bool is_bounded_by(const json& said, const json& taken) {
  constexpr auto least = std::numeric_limits<double>::lowest();
  constexpr auto most = std::numeric_limits<double>::max();
  for (const auto* key : {"minimum", "minLength", "minItems", "minProperties"})
    if (said.value(key, least) < taken.value(key, least))
      return false;
  for (const auto* key : {"maximum", "maxLength", "maxItems", "maxProperties"})
    if (said.value(key, most) > taken.value(key, most))
      return false;
  return true;
}

/// Finds what one version may say and the other one does not take.
class comparison {
public:
  std::vector<std::string> found;

  void compare(const rule_place& said, const rule_place& taken,
               const json::json_pointer& at) {
    for (const auto& x : said.choices()) {
      const auto all = taken.choices();
      const auto like = std::find_if(all.begin(), all.end(), [&](auto& y) {
        return is_within(kinds_of(*x.rule), kinds_of(*y.rule));
      });
      if (like == all.end())
        note(at, "its kind");
      else
        compare_one(x, *like, at);
    }
  }

private:
  void note(const json::json_pointer& at, const std::string& what) {
    found.push_back(at.to_string() + ": " + what);
  }

  void compare_one(const rule_place& said, const rule_place& taken,
                   const json::json_pointer& at) {
    const auto words = allowed_words(*said.rule);
    if (!is_within(words, allowed_words(*taken.rule)))
      note(at, "a word");
    if (words.empty() && !is_bounded_by(*said.rule, *taken.rule))
      note(at, "a bound");
    if (words.empty() && taken.rule->contains("pattern")
        && said.rule->value("pattern", "") != (*taken.rule)["pattern"])
      note(at, "a pattern");
    compare_members(said, taken, at);
    for (const auto* key : {"items", "additionalProperties", "propertyNames"})
      if (taken.rule->contains(key) && said.rule->contains(key))
        compare(said((*said.rule)[key]), taken((*taken.rule)[key]), at / key);
      else if (taken.rule->contains(key))
        note(at, key);
  }

  /// What only `said` describes is taken by everybody, and ignored.
  void compare_members(const rule_place& said, const rule_place& taken,
                       const json::json_pointer& at) {
    const auto always = strings_in(said.rule->value("required", json::array()));
    for (const auto& name :
         strings_in(taken.rule->value("required", json::array())))
      if (always.count(name) == 0)
        note(at / name, "it may be missing");
    const auto members = said.rule->value("properties", json::object());
    const auto known = taken.rule->value("properties", json::object());
    for (const auto& [name, rule] : known.items())
      if (members.contains(name))
        compare(said(members[name]), taken(rule), at / name);
  }
};

/// Places at which the one says what the other does not take.
std::vector<std::string> not_taken(const schema_set& said,
                                   const schema_set& taken) {
  comparison result;
  for (const auto& [name, rule] : said)
    if (const auto same = taken.find(name); same != taken.end())
      result.compare({&said, name, &rule}, {&taken, name, &same->second},
                     json::json_pointer{} / name);
  return result.found;
}

} // namespace

TEST_CASE("what a message of this version may say is taken by 7566a8a") {
  CHECK(not_taken(present_schemas(), earlier_schemas())
        == std::vector<std::string>{});
}

TEST_CASE("what a message of 7566a8a may say is taken by this version") {
  const auto earlier = earlier_schemas();
  CHECK(earlier.size() > 90);
  CHECK(not_taken(earlier, present_schemas()) == std::vector<std::string>{});
}

TEST_CASE("what another version would not take is found") {
  const auto earlier = earlier_schemas();
  auto later = earlier;
  auto& row = later["common"]["definitions"]["instance_row"];
  SECTION("a new word") {
    row["properties"]["health"]["enum"].push_back("asleep");
    const auto found = not_taken(later, earlier);
    REQUIRE_FALSE(found.empty());
    CHECK(found[0].find("/health: a word") != std::string::npos);
  }
  SECTION("a wider bound") {
    later["common"]["definitions"]["counter"]["minimum"] = -1;
    CHECK_FALSE(not_taken(later, earlier).empty());
  }
  SECTION("a member that has become optional") {
    row["required"].erase(0);
    CHECK_FALSE(not_taken(later, earlier).empty());
  }
  SECTION("but not a member that is new") {
    row["properties"]["colour"] = {{"type", "string"}};
    CHECK(not_taken(later, earlier).empty());
  }
}
