#include "tools/compare_poses/file_watch.hpp"

#include "test/skills/temp_folder.hpp"

#include <catch2/catch.hpp>

using roscell::comparison::file_watch;
using namespace roscell::test;

TEST_CASE("a watch tells that a file appears and grows, once each time") {
  temp_folder folder;
  file_watch watch{{folder / "lines"}};
  auto now = file_watch::clock::now();
  CHECK_FALSE(watch.wait_until(now));
  folder.write("lines", "one\n");
  CHECK(watch.wait_until(now + patience));
  CHECK_FALSE(watch.wait_until(now));
  folder.append("lines", "two\n");
  CHECK(watch.wait_until(now + patience));
}

TEST_CASE("a folder that is not there cannot be watched") {
  CHECK_THROWS_AS(file_watch({"/nowhere/lines"}), std::runtime_error);
}
