#include "cell_fixture.hpp"
#include "this_program.hpp"

#include <catch2/catch.hpp>

using namespace roscell;
using namespace roscell::test;

namespace {

constexpr std::size_t message_count = 3;

} // namespace

TEST_CASE("what the writer's process does", "[.][writer]") {
  variables environment;
  for (const char* name : {"ROS_DISCOVERY_SERVER", "ROS_DOMAIN_ID"})
    if (const auto* value = std::getenv(name))
      environment[name] = value;
  skill writing{environment};
  auto output = writing.output("/chatter", text);
  REQUIRE(writing.log.wait_for("a reader has come"));
  for (std::size_t i = 0; i < message_count; ++i)
    output->write(text_frame(std::to_string(i)));
  output->close();
}

TEST_CASE("messages go from process to process, and none is lost at the end") {
  cell home{5};
  skill reading{home.environment("reader")};
  running_input input{reading.input("/chatter", text)};
  auto writer = this_program("[writer]", home.environment("writer"));
  for (std::size_t i = 0; i < message_count; ++i)
    CHECK(text_of(input.sink().wait_for(i)) == std::to_string(i));
  auto code = writer.wait();
  CAPTURE(writer.output());
  CHECK(code == 0);
}

TEST_CASE("without a server, skills find each other by multicast") {
  // Of this run alone: others may be testing on this network.
  const auto domain = 10 + ::getpid() % 80;
  const variables alone{{"ROS_DOMAIN_ID", std::to_string(domain)}};
  skill reading{alone};
  running_input input{reading.input("/chatter", text)};
  auto writer = this_program("[writer]", alone);
  CHECK(input.sink().wait_for(message_count - 1));
  CHECK(writer.wait() == 0);
}
