#include "roscell/skill/try_out.hpp"

#include "roscell/skill/errors.hpp"
#include "test/skills/files.hpp"

#include <catch2/catch.hpp>

#include <stdexcept>

using namespace roscell::engine;
using roscell::test::temp_folder;

namespace {

/// Emits each frame's place in the input and its payload, to a second output.
class numbering : public executor {
public:
  void process(const frame& input, emitter& output) override {
    if (input.payload == "bad")
      throw std::runtime_error("a bad frame");
    output.emit(std::to_string(input.sequence) + " " + input.payload, 1);
    type = input.data_type;
  }

  void release() override {
    released = true;
  }

  std::string type;
  bool released = false;
};

} // namespace

TEST_CASE("an executor is tried with the lines of a file") {
  temp_folder folder{"in", "first\nsecond"};
  numbering subject;
  const auto results = try_out(subject, folder / "in", "text/plain");
  REQUIRE(results.size() == 2);
  CHECK(results[0].payload == "0 first");
  CHECK(results[1].payload == "1 second");
  CHECK(results[1].port == 1);
  CHECK(subject.type == "text/plain");
  CHECK(subject.released);
}

TEST_CASE("an executor is tried with the files of a folder") {
  temp_folder folder;
  folder.write("b.png", "bytes\nof b");
  folder.write("a.png", "bytes of a");
  numbering subject;
  const auto results = try_out(subject, folder / "", "image/png");
  REQUIRE(results.size() == 2);
  CHECK(results[0].payload == "0 bytes of a");
  CHECK(results[1].payload == "1 bytes\nof b");
}

TEST_CASE("what goes wrong in a trial reaches the test") {
  temp_folder folder{"in", "bad\n"};
  numbering subject;
  CHECK_THROWS_WITH(try_out(subject, folder / "in", "text/plain"),
                    "a bad frame");
  CHECK_THROWS_AS(try_out(subject, folder / "gone/in", "text/plain"),
                  start_error);
}
