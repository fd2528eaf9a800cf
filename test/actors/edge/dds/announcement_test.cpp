#include "actors/edge/dds/announcement.hpp"
#include "actors/edge/dds/limits.hpp"
#include "actors/edge/limits.hpp"
#include "actors/edge/session/session_frames.hpp"

#include <catch2/catch.hpp>

using namespace roscell;

namespace {

announcement sample() {
  announcement x;
  x.role = "coordinator";
  x.node = "alpha";
  x.cell = "yard";
  x.session = "10.0.0.5:8420";
  x.uuid = "3b241101-e2bb-4255-8caf-4136c566a962";
  x.incarnation = 42;
  return x;
}

} // namespace

TEST_CASE("an announcement survives its wire form", "[announcement]") {
  CHECK(decode(encode(sample())) == sample());
  auto odd = sample();
  odd.cell = "a;b=c%d\n\xc3\xa9 e";
  CHECK(decode(encode(odd)) == odd);
  CHECK(decode(encode(announcement{})) == announcement{});
}

TEST_CASE("an announcement names epoch, discovery server and its id",
          "[announcement]") {
  auto x = sample();
  x.epoch = 7;
  x.discovery = "10.0.0.5:11811";
  x.server = 255;
  x.cell_uuid = "9b8f";
  CHECK(decode(encode(x)) == x);
  auto bytes = encode(x);
  CHECK(bytes.substr(bytes.find("epoch="))
        == "epoch=7;discovery=10.0.0.5:11811;server=255;cell_uuid=9b8f;");
  for (auto change : {&announcement::epoch, &announcement::server}) {
    auto other = x;
    other.*change += 1;
    CHECK(other != x);
  }
}

TEST_CASE("the longest names and numbers fit into an announcement",
          "[announcement]") {
  announcement x;
  x.role = "coordinator";
  x.node = std::string(limits::text::name_bytes, '\xc3');
  x.cell = std::string(limits::text::name_bytes, ' ');
  x.session = "255.255.255.255:65535";
  x.discovery = x.session;
  x.uuid = "3b241101-e2bb-4255-8caf-4136c566a962";
  x.incarnation = session_frame_bounds::number;
  x.epoch = session_frame_bounds::number;
  x.server = 255;
  x.cell_uuid = x.uuid;
  CHECK(encode(x).size() <= limits::discovery::announcement_bytes);
  CHECK(decode(encode(x)) == x);
}

TEST_CASE("the wire form is the key=value; form of ROS 2", "[announcement]") {
  auto x = sample();
  x.node = "a b";
  CHECK(encode(x)
        == "roscell=1.0;role=coordinator;node=a%20b;cell=yard;"
           "session=10.0.0.5:8420;"
           "uuid=3b241101-e2bb-4255-8caf-4136c566a962;incarnation=42;");
}

TEST_CASE("an announcement of another version can be read to refuse it",
          "[announcement]") {
  auto x = decode("roscell=7.2;kind=unheard-of;node=beta;");
  REQUIRE(x);
  CHECK(x->protocol_version == "7.2");
  CHECK(x->node == "beta");
  CHECK(x->role.empty());
}

TEST_CASE("the USER_DATA of unauthenticated peers is no announcement",
          "[announcement]") {
  for (const char* bytes : {"",
                            "enclave=/;",
                            "roscell",
                            "roscell=",
                            "roscell=;",
                            "roscell=1.0",
                            "roscell=1.0;node",
                            "roscell=1.0;node=a",
                            "roscell=1.0;;",
                            "roscell=1.0;node=a;node=b;",
                            "roscell=1.0;node=%4;",
                            "roscell=1.0;node=%zz;",
                            "roscell=1.0;node=%",
                            "roscell=1.0;x=1;x=2;",
                            "roscell=1.0;incarnation=;",
                            "roscell=1.0;incarnation=-1;",
                            "roscell=1.0;incarnation=1e3;",
                            "roscell=1.0;incarnation=99999999999999999999;",
                            "roscell=1.0;epoch=x;",
                            "roscell=1.0;server=-1;"}) {
    CAPTURE(bytes);
    CHECK_FALSE(decode(bytes));
  }
}

TEST_CASE("an announcement over the limit is not looked at", "[announcement]") {
  auto x = sample();
  x.cell = std::string(limits::discovery::announcement_bytes, 'c');
  CHECK_FALSE(decode(encode(x)));
}

namespace roscell::test {

namespace {

using namespace std::chrono_literals;

const presence_table::time_point start{100h};

guid_prefix prefix(std::size_t number) {
  guid_prefix result{};
  result[0] = static_cast<std::uint8_t>(number);
  result[1] = static_cast<std::uint8_t>(number >> 8);
  return result;
}

announcement coordinator(const std::string& uuid) {
  announcement result;
  result.role = "coordinator";
  result.node = "base";
  result.uuid = uuid;
  return result;
}

} // namespace

TEST_CASE("One participant is one announcement, whatever it says",
          "[presence_table]") {
  presence_table table;
  std::size_t seen = 0;
  std::size_t gone = 0;
  for (int i = 0; i < 1000; ++i)
    for (const auto& x :
         table.remember(prefix(1), coordinator(std::to_string(i)), start)
             .changes)
      ++(x.gone ? gone : seen);
  CHECK(table.size() == 1);
  CHECK(seen == 1000);
  CHECK(gone == 999);
}

TEST_CASE("More participants than a bound are not listened to",
          "[presence_table]") {
  presence_table table;
  for (std::size_t i = 0; i < limits::unauthenticated_peers::participants; ++i)
    CHECK(table.remember(prefix(i), coordinator(std::to_string(i)), start)
              .newcomer);
  const auto late =
      table.remember(prefix(5000), coordinator("late"), start + 1h);
  CHECK_FALSE(late.newcomer);
  CHECK(late.changes.empty());
  CHECK(table.size() == limits::unauthenticated_peers::participants);
  CHECK(table.forget(prefix(0), start + 1h).size() == 1);
  CHECK(table.remember(prefix(5000), coordinator("late"), start + 1h).newcomer);
}

TEST_CASE("What is repeated is told again, but seldom", "[presence_table]") {
  presence_table table;
  CHECK(table.remember(prefix(1), coordinator("a"), start).changes.size() == 1);
  CHECK(
      table.remember(prefix(1), coordinator("a"), start + 59s).changes.empty());
  CHECK(table.remember(prefix(1), coordinator("a"), start + 60s).changes.size()
        == 1);
  CHECK(
      table.remember(prefix(1), coordinator("a"), start + 61s).changes.empty());
}

TEST_CASE("A node that two participants announce is there until both have gone",
          "[presence_table]") {
  presence_table table;
  auto spoof = coordinator("a");
  spoof.session = "10.6.6.6:666";
  table.remember(prefix(1), coordinator("a"), start);
  table.remember(prefix(2), spoof, start);
  // What the true one says is told anew.
  const auto changes = table.forget(prefix(2), start);
  REQUIRE(changes.size() == 1);
  CHECK_FALSE(changes[0].gone);
  CHECK(changes[0].said == coordinator("a"));
  const auto end = table.forget(prefix(1), start);
  REQUIRE(end.size() == 1);
  CHECK(end[0].gone);
  CHECK(table.forget(prefix(1), start).empty());
}

} // namespace roscell::test
