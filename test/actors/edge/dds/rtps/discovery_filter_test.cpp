#include "actors/edge/dds/rtps/discovery_probe.hpp"
#include "actors/edge/dds/rtps/discovery_wire.hpp"

#include <catch2/catch.hpp>

#include <string>
#include <string_view>

using namespace roscell;

namespace {

using bytes = std::vector<std::uint8_t>;

bytes from_hex(std::string_view text) {
  bytes result;
  std::string digits;
  for (char c : text) {
    if (c != ' ')
      digits.push_back(c);
    if (digits.size() == 2) {
      result.push_back(
          static_cast<std::uint8_t>(std::stoi(digits, nullptr, 16)));
      digits.clear();
    }
  }
  return result;
}

/// An RTPS header, as Fast DDS 2.9.1 writes it, and then what follows it.
bytes message(std::string_view hex) {
  auto result = from_hex("52545053 0203010f 010f78fd 8928b8ae 00000000");
  auto rest = from_hex(hex);
  result.insert(result.end(), rest.begin(), rest.end());
  return result;
}

bool passes(bytes x) {
  return make_safe(x.data(), x.size());
}

/// Submessages as captured from Fast DDS 2.9.1.
const std::string to_server = "0e010c00 4453035f 4550524f 53494d41 ";
const std::string heartbeat = "07011c00 000100c7 000100c2 00000000 01000000 "
                              "00000000 00000000 01000000 ";
const std::string acknack = "06011c00 000100c7 000100c2 00000000 01000000 "
                            "01000000 00000080 01000000 ";
const std::string gap = "08012000 000100c7 000100c2 00000000 04000000 "
                        "00000000 06000000 00000000 00000000 ";
const std::string gap_exact = "08011c00 000100c7 000100c2 00000000 04000000 "
                              "00000000 06000000 00000000 ";
const std::string statistics = "80013800 01000000 8b550000 00000000 00000000 "
                               "00000000 7f000001 68f9006b f01745f3 01000000 "
                               "00000000 80000000 00000000 00000000 00000000 ";

const std::string whole_heartbeat = to_server + heartbeat + statistics;
const std::string whole_acknack = to_server + acknack + statistics;
const std::string whole_gap = to_server + gap_exact;

/// A participant's data up to the parameter that a test is about.
bytes participant_with(std::string_view parameter_hex) {
  auto list = from_hex(std::string{"00030000 15000400 02030000 "
                                   "50001000 010f78fd 8928b8ae 00000000 "
                                   "000001c1 "}
                       + std::string{parameter_hex} + "01000000");
  auto size = 20 + list.size();
  auto result = message("1505 0000 00001000 000100c7 000100c2 "
                        "00000000 01000000");
  result[22] = static_cast<std::uint8_t>(size & 255);
  result[23] = static_cast<std::uint8_t>(size >> 8);
  result.insert(result.end(), list.begin(), list.end());
  return result;
}

} // namespace

TEST_CASE("what Fast DDS sends passes unchanged", "[discovery]") {
  for (auto& x : {message(whole_heartbeat), message(whole_acknack),
                  message(whole_gap), participant_with(""),
                  probe_question(make_probe_prefix(), sockaddr_in{}),
                  probe_farewell(make_probe_prefix())}) {
    auto copy = x;
    CHECK(make_safe(copy.data(), copy.size()));
    CHECK(copy == x);
  }
}

TEST_CASE("a datagram that is cut off anywhere does not pass", "[discovery]") {
  for (auto& x : {message(to_server + heartbeat),
                  participant_with("62000c00 08000000 726f7363 656c6c00 ")}) {
    for (std::size_t size = 0; size < x.size(); ++size) {
      CAPTURE(size);
      bytes cut(x.begin(), x.begin() + static_cast<std::ptrdiff_t>(size));
      // Between two submessages it is a whole message.
      CHECK(passes(cut) == (x == message(to_server + heartbeat) && size == 36));
    }
  }
}

TEST_CASE("only the submessages of discovery pass", "[discovery]") {
  CHECK_FALSE(passes(message("16012400 " + std::string(72, '0')))); // DATA_FRAG
  CHECK_FALSE(passes(message("30010400 00000000")));
  CHECK_FALSE(passes(message("0e010000")));
  CHECK_FALSE(passes(message("0e010b00 4453035f 4550524f 53494d")));
  CHECK_FALSE(passes(message(statistics + to_server)));
  CHECK_FALSE(passes(message("80010400 00000000")));
}

TEST_CASE("numbers that would keep Fast DDS busy do not pass", "[discovery]") {
  auto too_many_bits = message(acknack);
  too_many_bits[20 + 4 + 16 + 1] = 0x10; // 0x1001 bits.
  CHECK_FALSE(passes(too_many_bits));
  CHECK_FALSE(passes(message(gap))); // Longer than its set.
  auto wide_gap = message(gap_exact);
  wide_gap[20 + 4 + 16] = 1; // The high half of the base.
  CHECK_FALSE(passes(wide_gap));
  auto backwards = message(heartbeat);
  backwards[20 + 4 + 12] = 9; // First is 9, last is 0.
  CHECK_FALSE(passes(backwards));
}

TEST_CASE("properties whose lengths lie do not pass", "[discovery]") {
  const std::string name = "0b000000 44535f56 45525349 4f4e0000 ";
  CHECK(passes(
      participant_with("59001c00 01000000 " + name + "04000000 322e3000 ")));
  // The value claims more than there is, the name does, the count does.
  CHECK_FALSE(passes(
      participant_with("59001c00 01000000 " + name + "ff000000 322e3000 ")));
  CHECK_FALSE(passes(
      participant_with("59001c00 01000000 ffffffff 44535f56 45525349 4f4e0000 "
                       "04000000 322e3000 ")));
  CHECK_FALSE(passes(
      participant_with("59001c00 02000000 " + name + "04000000 322e3000 ")));
}

TEST_CASE("a discovery server version that is no number does not pass",
          "[discovery]") {
  for (const char* value : {"78000000", "00000000", "2e300000", "2d310000"})
    CHECK_FALSE(passes(participant_with(
        "59001c00 01000000 0b000000 44535f56 45525349 4f4e0000 "
        "02000000 "
        + std::string{value} + ' ')));
  // Fast DDS ends the name at its first zero.
  CHECK_FALSE(passes(participant_with(
      "59002000 01000000 10000000 44535f56 45525349 4f4e0041 41414100 "
      "02000000 78000000 ")));
}

TEST_CASE("a parameter of the wrong size does not pass", "[discovery]") {
  CHECK_FALSE(passes(participant_with("02000400 58020000 ")));
  CHECK_FALSE(passes(participant_with("62000400 08000000 ")));
  CHECK_FALSE(passes(participant_with("2c000400 01000000 ")));
  CHECK_FALSE(passes(participant_with("99990200 0000 ")));
}

TEST_CASE("discovery data about something else than they may be about does "
          "not pass",
          "[discovery]") {
  auto endpoint = participant_with("");
  endpoint[endpoint.size() - 5] = 0xc2; // The entity, before the sentinel.
  CHECK_FALSE(passes(endpoint));
  CHECK_FALSE(passes(
      participant_with("70001000 010f78fd 8928b8ae 00000001 000001c1 ")));
  auto publication = participant_with("");
  publication[20 + 4 + 10] = 3; // Written by the publications' writer.
  publication[20 + 4 + 9] = 0;
  CHECK_FALSE(passes(publication));
}

TEST_CASE("descriptions of types and security become padding", "[discovery]") {
  auto x = participant_with("75000400 deadbeef 01100400 deadbeef ");
  auto size = x.size();
  REQUIRE(make_safe(x.data(), size));
  CHECK(x == participant_with("00000400 deadbeef 00000400 deadbeef "));
}

TEST_CASE("a participant that came by multicast seems to take no answer",
          "[discovery]") {
  // It announces and detects participants, and is a publications' announcer.
  auto little = participant_with("58000400 07000000 ");
  REQUIRE(make_safe(little.data(), little.size(), arrival::direct));
  CHECK(little == participant_with("58000400 07000000 "));
  REQUIRE(make_safe(little.data(), little.size(), arrival::multicast));
  CHECK(little == participant_with("58000400 05000000 "));
  // The same parameter list in the other byte order.
  auto big = message("1505 2c00 00001000 000100c7 000100c2 00000000 01000000 "
                     "00020000 00500010 010f78fd 8928b8ae 00000000 000001c1 "
                     "00580004 00000007 00010000");
  big[22] = static_cast<std::uint8_t>(big.size() - 24);
  REQUIRE(make_safe(big.data(), big.size(), arrival::multicast));
  CHECK(big[big.size() - 5] == 5);
}
