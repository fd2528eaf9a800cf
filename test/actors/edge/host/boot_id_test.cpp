#include "actors/edge/host/boot_id.hpp"
#include "test/actors/edge/process/supervision_fixture.hpp"

#include <catch2/catch.hpp>

namespace roscell::test {

namespace {

/// What proc(5) says of a host, as far as its boot is concerned.
struct paper_host {
  paper_host(const std::string& id, const std::string& started) {
    folder.write("sys/kernel/random/boot_id", id);
    // Field 22; the name in the second one may hold anything.
    folder.write("1/stat",
                 "1 (a) b (init) S 0 1 1 0 -1 4194560 1 2 3 4 5 6 7 8 "
                 "20 0 1 0 "
                     + started + " 1 2\n");
  }

  std::string boot() const {
    return this_boot(folder.path());
  }

  own_folder folder;
};

} // namespace

TEST_CASE("A boot is another one with its id, or with the first process",
          "[boot_id]") {
  const paper_host host{"b-1\n", "7"};
  CHECK_FALSE(host.boot().empty());
  CHECK(paper_host{"b-1\n", "7"}.boot() == host.boot());
  CHECK(paper_host{"b-2\n", "7"}.boot() != host.boot());
  // A container that is the host of a node was started again.
  CHECK(paper_host{"b-1\n", "8"}.boot() != host.boot());
}

TEST_CASE("A boot that cannot be read is not known", "[boot_id]") {
  CHECK(this_boot("/nonexistent").empty());
  CHECK(paper_host{"", "7"}.boot().empty());
  CHECK(paper_host{"\n", "7"}.boot().empty());
  CHECK(paper_host{"b-1\n", "x"}.boot().empty());
  CHECK(paper_host{std::string(1000, 'b'), "7"}.boot().empty());
}

TEST_CASE("This host has a boot", "[boot_id]") {
  CHECK_FALSE(this_boot().empty());
  CHECK(this_boot() == this_boot());
}

} // namespace roscell::test
