#include "actors/edge/dds/announcement.hpp"
#include "actors/edge/dds/limits.hpp"
#include "actors/edge/io/limits.hpp"
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
