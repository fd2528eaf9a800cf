#include "test/actors/edge/dds/discovery_fixture.hpp"

using namespace roscell;
using namespace roscell::test;

namespace {

constexpr std::uint8_t cell_id = 1;
constexpr std::uint8_t member_id = 2;

/// What the cell's server sees: "+server", "-server".
on_sighting writing(diary& to) {
  return [&to](const sighting& seen) {
    if (seen.what == sighting::kind::changed)
      return;
    const bool ended =
        seen.what == sighting::kind::left || seen.what == sighting::kind::lost;
    const std::string sign = ended ? "-" : "+";
    if (seen.prefix[0] == server_prefix(0)[0])
      to.add(sign + "server");
  };
}

/// The discovery server of a cell and that of a member.
struct pair_of_servers {
  diary seen;
  std::unique_ptr<cell_server> cell =
      must_open(local_server(cell_id, ""), writing(seen));
  std::unique_ptr<cell_server> member;

  pair_of_servers() {
    auto options = local_server(member_id, "");
    options.remote = remote_server{"127.0.0.1", cell->port(), cell_id};
    member = must_open(options);
    meet();
    REQUIRE(seen.wait_for("+server"));
  }

  void meet() {
    cell->meet(member_id);
    member->meet(cell_id);
  }

  void part() {
    cell->lose(member_id);
    member->lose(cell_id);
  }
};

} // namespace

TEST_CASE("servers that met again know each other anew") {
  pair_of_servers both;
  for (std::size_t n = 2; n < 6; ++n) {
    if (n % 2 == 0) {
      both.part();
      REQUIRE(both.seen.wait_for("-server", n - 1));
    }
    both.meet(); // Also where nobody has noticed an end.
    REQUIRE(both.seen.wait_for("+server", n));
    CHECK(both.seen.wait_for("-server", n - 1));
  }
}
