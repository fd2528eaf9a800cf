#include "tools/roscell/top/layout/frame.hpp"

#include "test/words.hpp"

#include <catch2/catch.hpp>

using namespace roscell;
using namespace roscell::cli;
using namespace roscell::cli::top;

namespace {

/// A cell with a GPU on one of two nodes, and a task.
struct frame_bench {
  cell_model known;
  std::vector<std::string> log;
  controls now;

  frame_bench() {
    node_description asked;
    asked.role = node_role::coordinator;
    asked.identity.name = "head";
    cell_description cell;
    cell.cell = "line";
    for (const auto* name : {"head", "arm"}) {
      auto& row = cell.nodes.emplace_back();
      row.identity.name = name;
      row.identity.uuid = std::string{"u-"} + name;
      row.state = row_state::active;
      row.resources.cpu = {4, 2};
      row.resources.memory_mib = {4096, 1024};
      row.resources.disk_mib = {20000, 5000};
    }
    cell.nodes[1].resources.gpus = {{0, "a GPU", {8192, 4096}}};
    instance_row row;
    row.spec.instance = "t-a-1";
    row.spec.task = "t";
    row.spec.step = "a";
    row.spec.gpu = 0;
    row.spec.resources = {1, 512, 0, 2048};
    row.node = "arm";
    row.state = instance_state::running;
    row.restarts = 2;
    cell.nodes[1].instances = {row};
    cell.tasks = {{"t", task_state::running, 1000, 0, {row}}};
    known.open({}, 1000);
    known.set_cell(asked, cell);
  }

  frame shown(size_t width, size_t height) const {
    return make_frame({known, log, now}, {width, height, false, 61'000});
  }

  std::string text(size_t width = 80, size_t height = 24) const {
    std::string result;
    for (const auto& x : shown(width, height).lines)
      result += text_of(x) + "\n";
    return result;
  }
};

using roscell::test::has;

} // namespace

TEST_CASE("a screen has as many lines as there are, none of them too wide",
          "[top]") {
  frame_bench x;
  for (const auto where : {top_page::overview, top_page::details, top_page::log,
                           top_page::events, top_page::help}) {
    x.now.where = where;
    for (size_t width = 1; width < 130; width += 3)
      for (size_t height = 0; height < 30; ++height) {
        const auto shown = x.shown(width, height);
        CHECK(shown.lines.size() == height);
        for (const auto& line : shown.lines)
          CHECK(width_of(line) <= width);
      }
  }
}

TEST_CASE("80 columns and 24 lines show nodes, tasks and instances", "[top]") {
  const auto text = frame_bench{}.text();
  INFO(text);
  CHECK(has(text, "cell line  live  2 nodes  1 task  1 instance  head"));
  CHECK(has(text, "all is well"));
  CHECK(has(text, ">NODE 2 ^"));
  CHECK(has(text, ">arm"));
  CHECK(has(text, " TASK 1 ^"));
  CHECK(has(text, " INSTANCE 1 ^"));
  CHECK(has(text, "RESTARTS"));
}

TEST_CASE("what instances have reserved is not counted as used by others",
          "[top]") {
  frame_bench x;
  const auto text = x.text();
  INFO(text);
  // Of 2 cores in use one is reserved by the instance on the node.
  CHECK(has(text, "###+++...."));
  CHECK(has(text, "2/4"));
}

TEST_CASE("the memory of a GPU is there where there is one", "[top]") {
  frame_bench x;
  CHECK(has(x.text(200), "GPU MEMORY"));
  CHECK(has(x.text(200), "4/8 GiB"));
  x.now.filter = "head";
  CHECK_FALSE(has(x.text(200), "4/8 GiB"));
}

TEST_CASE("a node that does not answer is said, and what it is that is shown",
          "[top]") {
  frame_bench x;
  x.known.lose("cannot connect", 51'000);
  const auto text = x.text();
  CHECK(has(text, "NO ANSWER for 10s"));
  CHECK(has(text, "as it was last; looking again: cannot connect"));
  CHECK(has(text, "arm"));
}

TEST_CASE("a member says that it knows of itself only", "[top]") {
  frame_bench x;
  node_description asked;
  asked.coordinator = "10.0.0.1:8420";
  x.known.set_cell(asked, cell_around(asked));
  CHECK(has(x.text(), "this node only; the whole cell: --to 10.0.0.1:8420"));
}

TEST_CASE("the help is read on 80 columns and 24 lines without moving",
          "[top]") {
  frame_bench x;
  x.now.where = top_page::help;
  const auto text = x.text();
  INFO(text);
  CHECK(has(text, "Up Down PgUp PgDn Home End   move"));
  CHECK(has(text, "nothing within `roscell shell`"));
  CHECK(has(text, "all else is told by events."));
  CHECK_FALSE(has(text, "…"));
}

TEST_CASE("details of a thing that is gone say so", "[top]") {
  frame_bench x;
  x.now.where = top_page::details;
  x.now.subject = {thing_kind::task, "t"};
  CHECK(has(x.text(), "Kind:           task"));
  x.now.subject.name = "u";
  CHECK(has(x.text(), "it is gone"));
}

TEST_CASE("a text shows its end, or from where somebody looks", "[top]") {
  frame_bench x;
  x.now.where = top_page::log;
  for (int i = 0; i < 100; ++i)
    x.log.push_back("line " + std::to_string(i) + ".");
  x.now.at_end = true;
  CHECK(has(x.text(), "line 99."));
  x.now.at_end = false;
  x.now.scroll = 10;
  CHECK(has(x.text(), "line 10."));
  CHECK_FALSE(has(x.text(), "line 9."));
  x.now.text_filter = "Line 42";
  CHECK(has(x.text(), "line 42."));
  CHECK_FALSE(has(x.text(), "line 10."));
}

TEST_CASE("each list has some lines, the one that keys mean the most",
          "[top]") {
  using heights = std::array<size_t, listed_kinds.size()>;
  CHECK(list_heights({3, 2, 4}, 0, 20) == heights{3, 2, 4});
  CHECK(list_heights({100, 100, 100}, 1, 20) == heights{3, 14, 3});
  CHECK(list_heights({100, 2, 100}, 0, 20) == heights{15, 2, 3});
  CHECK(list_heights({100, 100, 100}, 2, 2) == heights{0, 0, 2});
  CHECK(list_heights({5, 5, 5}, 0, 0) == heights{0, 0, 0});
}
