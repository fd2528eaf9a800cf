#include "actors/edge/disk/small_file.hpp"

#include "test/actors/edge/process/supervision_fixture.hpp"

#include <sys/stat.h>

#include <string>

using namespace roscell;
using namespace roscell::test;

TEST_CASE("a small file is read whole, up to its bound, and not beyond") {
  temp_folder folder;
  constexpr size_t bound = 10'000;
  for (const size_t size : {0UL, 1UL, 4095UL, 4096UL, 4097UL, bound}) {
    const std::string text(size, 'x');
    folder.write("file", text);
    CHECK(read_small_file(folder.path() / "file", bound) == text);
  }
  folder.write("file", std::string(bound + 1, 'x'));
  CHECK_FALSE(read_small_file(folder.path() / "file", bound));
}

TEST_CASE("a small file takes the memory that it has, whatever its bound") {
  temp_folder folder{"file", std::string(100, 'x')};
  const auto text = read_small_file(folder.path() / "file", 1024 * 1024);
  REQUIRE(text);
  CHECK(text->capacity() < 200);
}

TEST_CASE("a small file is none where there is no file, or a pipe is empty") {
  temp_folder folder;
  CHECK_FALSE(read_small_file(folder.path() / "none", 10));
  CHECK_FALSE(read_small_file(folder.path(), 10));
  REQUIRE(::mkfifo((folder.path() / "pipe").c_str(), 0600) == 0);
  CHECK(read_small_file(folder.path() / "pipe", 10) == "");
}
