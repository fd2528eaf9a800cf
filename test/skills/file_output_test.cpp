#include "roscell/skill/errors.hpp"
#include "skills/engine/file/file_output.hpp"
#include "skills/engine/file/file_protocol.hpp"

#include "test/skills/support.hpp"

#include <catch2/catch.hpp>

#include <filesystem>

using namespace roscell::engine;
using namespace roscell::test;
using Catch::Matchers::Contains;

namespace {

std::unique_ptr<output_handler>
make_output(const std::string& path, const std::string& type = "text/plain") {
  auto result =
      make_file_output({{"file", path, type}, {}, [](const std::string&) {}});
  result->open();
  return result;
}

frame named(const std::string& name, const std::string& payload) {
  frame result;
  result.name = name;
  result.payload = payload;
  return result;
}

} // namespace

TEST_CASE("frames are appended to a file as lines") {
  temp_folder folder{"out", "before\n"};
  auto output = make_output(folder / "out");
  output->write(named("a", "one"));
  output->write(named("b", "two\n"));
  output->write(named("c", ""));
  output->close();
  CHECK(content_of(folder / "out") == "before\none\ntwo\n\n");
}

TEST_CASE("the folders above an output are made") {
  temp_folder folder;
  make_output(folder / "a/b/out")->write(named("x", "1"));
  make_output(folder / "c/d/")->write(named("x", "2"));
  CHECK(content_of(folder / "a/b/out") == "1\n");
  CHECK(content_of(folder / "c/d/x") == "2");
}

TEST_CASE("a folder gets one complete file per frame") {
  temp_folder folder;
  std::filesystem::create_directory(folder / "out");
  auto output = make_output(folder / "out", "image/png");
  output->write(named("1.png", "first"));
  output->write(named("2.png", "second\n"));
  output->write(named("1.png", "again"));
  output->close();
  CHECK(names_in(folder / "out") == std::vector<std::string>{"1.png", "2.png"});
  CHECK(content_of(folder / "out/1.png") == "again");
  CHECK(content_of(folder / "out/2.png") == "second\n");
}

TEST_CASE("the name of a frame cannot lead out of its folder") {
  frame f;
  f.sequence = 7;
  CHECK(file_name_of(f) == "7");
  CHECK(file_name_of(named("../../etc/passwd", "")) == "_._.._etc_passwd");
  CHECK(file_name_of(named(".", "")) == "_");
  CHECK(file_name_of(named(std::string("a\0b", 3), "")) == "a_b");
  CHECK(file_name_of(named(std::string(999, 'x') + ".png", "")).size() == 250);
}

TEST_CASE("a full disk is reported with its remedy") {
  CHECK_THROWS_WITH(make_output("/dev/full")->write(named("x", "1")),
                    Contains("'/dev/full'") && Contains("No space left")
                        && Contains("free space"));
}

TEST_CASE("an unusable output is refused with its path") {
  temp_folder folder{"file", ""};
  CHECK_THROWS_WITH(make_output(folder / "file/out"), Contains("/file"));
  CHECK_THROWS_WITH(make_output(folder / "file/out/"), Contains("/file/out"));
  CHECK_THROWS_WITH(make_output("relative"), Contains("absolute path"));
  CHECK_THROWS_WITH(make_output(folder / "x.png", "image/png"),
                    Contains("end the path with '/'"));
}
