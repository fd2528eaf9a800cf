#include "test/temp_folder.hpp"
#include "tools/roscell/completion/completion.hpp"
#include "tools/roscell/shell/editing/history_file.hpp"
#include "tools/roscell/shell/editing/line_editor.hpp"

#include <catch2/catch.hpp>

#include <cstdlib>
#include <fstream>

using namespace roscell;
using namespace roscell::cli;
namespace fs = std::filesystem;

namespace {

using words = std::vector<std::string>;

} // namespace

TEST_CASE("the history is the user's own file", "[shell]") {
  const test::temp_folder folder;
  const auto file = folder.path() / "state/history";
  CHECK(history_file{file}.add("tasks"));
  CHECK(fs::status(file).permissions()
        == (fs::perms::owner_read | fs::perms::owner_write));
  CHECK(history_file{file}.lines() == words{"tasks"});
}

TEST_CASE("the history keeps what somebody wants again", "[shell]") {
  const test::temp_folder folder;
  history_file kept{folder.path() / "history"};
  CHECK(kept.add("tasks"));
  CHECK_FALSE(kept.add("tasks"));
  CHECK_FALSE(kept.add(" secret"));
  CHECK_FALSE(kept.add(""));
  CHECK_FALSE(kept.add("two\nlines"));
  CHECK(kept.add("nodes"));
  CHECK(kept.add("tasks"));
  CHECK(history_file{folder.path() / "history"}.lines()
        == words{"tasks", "nodes", "tasks"});
}

TEST_CASE("the history is bounded", "[shell]") {
  const test::temp_folder folder;
  const auto file = folder.path() / "history";
  std::ofstream out{file};
  for (size_t i = 0; i < history_file::most_lines + 10; ++i)
    out << "line " << i << "\n";
  out.close();
  CHECK(history_file{file}.lines().front() == "line 10");
  CHECK(history_file{file}.lines().size() == history_file::most_lines);
}

TEST_CASE("two shells add to one history", "[shell]") {
  const test::temp_folder folder;
  history_file one{folder.path() / "history"};
  history_file two{folder.path() / "history"};
  one.add("a");
  two.add("b");
  one.add("c");
  CHECK(history_file{folder.path() / "history"}.lines()
        == words{"a", "b", "c"});
}

TEST_CASE("a history that cannot be written stops nobody", "[shell]") {
  CHECK(history_file{"/dev/null/history"}.add("tasks"));
  CHECK(history_file{""}.add("tasks"));
}

TEST_CASE("marks of what is pasted are taken out", "[shell]") {
  paste_filter filter;
  CHECK(filter.add("a\tb") == "a\tb");
  CHECK(filter.add("\x1b[200~{\n\t1}\x1b[201~\t") == "{\n 1}\t");
}

TEST_CASE("marks may come in parts, cut anywhere", "[shell]") {
  const std::string typed = "x\t\x1b[200~{\n\t1}\x1b[201~\ty";
  for (size_t first = 0; first <= typed.size(); ++first)
    for (size_t second = first; second <= typed.size(); ++second) {
      paste_filter filter;
      auto text = filter.add(typed.substr(0, first));
      text += filter.add(typed.substr(first, second - first));
      text += filter.add(typed.substr(second));
      INFO(first << " " << second);
      CHECK(text == "x\t{\n 1}\ty");
    }
}

TEST_CASE("other keys are not kept back", "[shell]") {
  paste_filter filter;
  CHECK(filter.add("\x1b[A") == "\x1b[A");
  CHECK(filter.add("\x1b[2~") == "\x1b[2~");
  CHECK(filter.add("\x1b"
                   "b")
        == "\x1b"
           "b");
}

TEST_CASE("Escape comes with the key behind it", "[shell]") {
  paste_filter filter;
  CHECK(filter.add("\x1b").empty());
  CHECK(filter.add("b")
        == "\x1b"
           "b");
  CHECK(filter.add("\x1b").empty());
  CHECK(filter.add("\x1b") == "\x1b");
}

TEST_CASE("names are found in the answers of a node", "[shell]") {
  const auto cell = json::parse(
      R"({"nodes":[{"identity":{"name":"head"}}],"free":[{"name":"arm"}]})");
  CHECK(names_in("nodes", cell) == words{"head", "arm"});
  const auto tasks = json::parse(R"({"tasks":[{"task":"t"},{"task":7},{}]})");
  CHECK(names_in("tasks", tasks) == words{"t"});
  const auto instances =
      json::parse(R"({"instances":[{"spec":{"instance":"t-a-1"}}]})");
  CHECK(names_in("instances", instances) == words{"t-a-1"});
  const auto node = json::parse(R"({"actors":[{"name":"member","id":7}]})");
  CHECK(names_in("actors", node) == words{"member"});
  CHECK(names_in("planets", tasks).empty());
  const auto skills = R"({"skills": [{"skill": {"descriptor": {"models": [
      {"name": "m", "parameters": {"size": 4,
       "gain": {"type": "number", "changeable": true},
       "loop": {"type": "boolean"}}}, {"name": "n"}]}}}]})"_json;
  CHECK(names_in("parameters", skills) == words{"gain="});
}
