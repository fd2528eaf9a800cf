#include "actors/instances/process/process_runtime.hpp"

#include "test/actors/instances/process/process_bench.hpp"

#include <sys/stat.h>

#include <fstream>
#include <string>

using namespace roscell;
using namespace roscell::test;

TEST_CASE("a log is kept with a bound and can be read on") {
  process_bench b;
  b.config.log_bytes = 8192;
  b.restart();
  b.start("i=0; while [ $i -lt 5000 ]; do echo line $i; i=$((i+1)); done");
  b.reported.await("exit 0");
  const auto kept = b.log(0);
  CHECK(kept.text.size() <= 8192);
  CHECK(kept.text.find("line 4999\n") != std::string::npos);
  CHECK(kept.ended);
  CHECK(b.log(-1).text.find("line 4980\n") == 0);
}

TEST_CASE("following a log waits for more, and for its end") {
  process_bench b;
  // One for each word: who opens one for the second time may still meet the end
  // of the first.
  const auto go_on = (b.folder.path() / "go_on").string();
  const auto end = (b.folder.path() / "end").string();
  REQUIRE(::mkfifo(go_on.c_str(), 0600) == 0);
  REQUIRE(::mkfifo(end.c_str(), 0600) == 0);
  b.start("echo one; read x <" + go_on + "; echo two; read x <" + end);
  auto part = b.log(0, 20'000);
  CHECK(part.text == "one\n");
  std::ofstream{go_on} << "\n";
  part = b.log(part.next_offset, 20'000);
  CHECK(part.text == "two\n");
  CHECK_FALSE(part.ended);
  std::ofstream{end} << "\n";
  part = b.log(part.next_offset, 20'000);
  CHECK(part.text.empty());
  CHECK(part.ended);
}

TEST_CASE("a follower whose time is over gets an empty part") {
  process_bench b;
  b.start(endless);
  const auto part = b.log(0, 50);
  CHECK(part.text.empty());
  CHECK_FALSE(part.ended);
}
