#include "tools/roscell/completion/completer.hpp"

#include "tools/roscell/shell/vocabulary.hpp"

#include <CLI/CLI.hpp>
#include <catch2/catch.hpp>

#include <algorithm>

using namespace roscell::cli;

namespace {

using words = std::vector<std::string>;

std::vector<std::string> some_names(const std::string& kind) {
  return {kind + "-1", kind + "-2"};
}

completions after(const std::string& line) {
  CLI::App app;
  action chosen;
  set_up_vocabulary(app, chosen, nullptr);
  return complete(app, line, some_names);
}

words offered(const std::string& line) {
  return after(line).words;
}

} // namespace

TEST_CASE("the shell completes commands and its own words", "[shell]") {
  CHECK(offered("tre") == words{"tree"});
  CHECK(offered("no") == words{"node", "nodes"});
  CHECK(offered("  tas") == words{"tasks"});
  CHECK(offered("skills n") == words{"new"});
  CHECK(offered("roscell tre") == words{"tree"});
  CHECK(offered("xyz").empty());
  const auto all = offered("");
  CHECK(std::count(all.begin(), all.end(), "follow") == 1);
  CHECK(std::count(all.begin(), all.end(), "describe") == 1);
}

TEST_CASE("the shell completes names of what lives", "[shell]") {
  CHECK(offered("tasks ") == words{"tasks-1", "tasks-2"});
  CHECK(offered("logs -f ") == words{"instances-1", "instances-2"});
  CHECK(offered("exec -T ") == words{"instances-1", "instances-2"});
  CHECK(offered("exec instances-1 ").empty());
  CHECK(offered("transfer ") == words{"nodes-1", "nodes-2"});
  CHECK(offered("transfer nodes-1 ") == words{"cells-1", "cells-2"});
  CHECK(offered("tree nodes-2") == words{"nodes-2"});
  CHECK(offered("follow ") == words{"kinds-1", "kinds-2"});
  CHECK(offered("follow -s ") == words{"subjects-1", "subjects-2"});
  CHECK(offered("form nodes-1 ") == words{"nodes-1", "nodes-2"});
}

TEST_CASE("the shell completes options and their values", "[shell]") {
  CHECK(offered("status --ac") == words{"--actors"});
  CHECK(offered("status -o ") == words{"json", "table"});
  CHECK(offered("status --output=j") == words{"--output=json"});
  CHECK(offered("help rel") == words{"release"});
  CHECK(offered("tasks --to /x tas") == words{"tasks-1", "tasks-2"});
}

TEST_CASE("the shell completes files, and goes on in folders", "[shell]") {
  CHECK(offered("check /etc/hostn") == words{"/etc/hostname"});
  const auto folder = after("check /et");
  CHECK(folder.words == words{"/etc/"});
  CHECK(folder.goes_on);
  CHECK_FALSE(after("tre").goes_on);
}

TEST_CASE("the word that is completed is known by its place", "[shell]") {
  CHECK(after("logs  inst").begin == 6);
  CHECK(after("logs ").begin == 5);
}

TEST_CASE("several words have a common beginning", "[shell]") {
  CHECK(common_beginning({}).empty());
  CHECK(common_beginning({"one"}) == "one");
  CHECK(common_beginning({"transfer", "transfers"}) == "transfer");
  CHECK(common_beginning({"a", "b"}).empty());
}

TEST_CASE("a common beginning has whole characters only", "[shell]") {
  // Both begin with the same byte of another character.
  CHECK(common_beginning({"größe", "grüße"}) == "gr");
  CHECK(common_beginning({"机器", "机场"}) == "机");
  CHECK(replacement({0, {"größe", "grüße"}, false}) == "gr");
}

TEST_CASE("what is certain takes the place of a word", "[shell]") {
  CHECK(replacement({0, {"tree"}, false}) == "tree ");
  CHECK(replacement({0, {"/etc/"}, true}) == "/etc/");
  CHECK(replacement({0, {"transfer", "transfers"}, false}) == "transfer");
  CHECK(replacement({0, {"one", "two"}, false}).empty());
  CHECK(replacement({0, {"a b"}, false}) == "'a b' ");
}
