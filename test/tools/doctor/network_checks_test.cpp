#include "tools/roscell/doctor/network/addresses.hpp"
#include "tools/roscell/doctor/network/bound_ports.hpp"
#include "tools/roscell/doctor/network/buffers.hpp"
#include "tools/roscell/doctor/network/ports.hpp"

#include <catch2/catch.hpp>

#include <cerrno>

using namespace roscell;
using namespace roscell::cli;
using Catch::Contains;

namespace {

const interface_address eth0{"eth0", "10.0.0.5", "", false, true};
const interface_address lo{"lo", "127.0.0.1", "", true, false};

link_readings good_link() {
  return {true, true, true, true, 1500};
}

} // namespace

TEST_CASE("an interface without a carrier is broken", "[doctor]") {
  auto link = good_link();
  CHECK(judge_interface("", {eth0, lo}, link).how == judgement::ok);
  link.carrier = false;
  const auto found = judge_interface("eth0", {eth0, lo}, link);
  CHECK(found.how == judgement::broken);
  CHECK_THAT(found.seen, Contains("no carrier"));
}

TEST_CASE("a host with loopback only can have no other member", "[doctor]") {
  CHECK(judge_interface("", {lo}, good_link()).how == judgement::warning);
  CHECK(judge_interface("lo", {lo}, good_link()).how == judgement::ok);
  CHECK(judge_interface("", {}, {}).how == judgement::broken);
}

TEST_CASE("a name that is none is told with those that there are", "[doctor]") {
  const auto found = judge_interface("eth7", {eth0, lo}, {});
  CHECK(found.how == judgement::broken);
  CHECK_THAT(found.seen, Contains("eth0 10.0.0.5"));
  CHECK(found.remedy == "roscell node --interface eth0");
}

TEST_CASE("a small MTU is told with the fragments of a datagram", "[doctor]") {
  auto link = good_link();
  CHECK(judge_mtu(eth0, link).how == judgement::ok);
  link.mtu = 1280;
  const auto found = judge_mtu(eth0, link);
  CHECK(found.how == judgement::warning);
  CHECK_THAT(found.matters, Contains("52 fragments instead of 45"));
}

TEST_CASE("multicast has to leave by the interface of the node", "[doctor]") {
  auto link = good_link();
  CHECK(judge_multicast(eth0, link, {0, "10.0.0.5"}).how == judgement::ok);
  CHECK(judge_multicast(eth0, link, {0, "192.168.0.5"}).remedy
        == "sudo ip route replace 239.255.0.1/32 dev eth0");
  CHECK(judge_multicast(eth0, link, {ENETUNREACH, ""}).how
        == judgement::warning);
  CHECK(judge_multicast(lo, {}, {}).how == judgement::skipped);
  link.multicast = false;
  CHECK(judge_multicast(eth0, link, {0, "10.0.0.5"}).remedy
        == "sudo ip link set dev eth0 multicast on");
}

TEST_CASE("socket buffers are judged by what skills ask for", "[doctor]") {
  CHECK(judge_buffers({8 << 20, 8 << 20}).how == judgement::ok);
  CHECK(judge_buffers({212992, 8 << 20}).how == judgement::warning);
  CHECK(judge_buffers({8 << 20, 212992}).how == judgement::warning);
  CHECK_THAT(judge_buffers({212992, 212992}).matters,
             Contains("an image of 1280x960"));
  // What flows may be larger than what is usual.
  const auto found = judge_buffers({8 << 20, 8 << 20}, image_of(3840, 2160));
  CHECK(found.how == judgement::warning);
  CHECK_THAT(found.matters, Contains("3840x2160 in colour has 24 MiB"));
  CHECK_THAT(found.remedy, Contains("net.core.rmem_max=24883200"));
}

TEST_CASE("a node cannot do without its HTTP port", "[doctor]") {
  const port_readings taken{"tcp", 8420, EADDRINUSE, "pid 7 (nginx)", 7};
  CHECK(judge_port({"tcp", 8420, 0, "", 0}, true).how == judgement::ok);
  CHECK(judge_port(taken, true).how == judgement::broken);
  // Whose program it is, and what for, is not known here.
  CHECK(judge_port(taken, true).remedy == "ps -o pid,user,lstart,args -p 7");
  CHECK(judge_port({"udp", 11811, EADDRINUSE, "", 0}, false).how
        == judgement::warning);
}

TEST_CASE("a node that has its ports is told by its name", "[doctor]") {
  const auto found = judge_node_there("arm", "10.0.0.5:8420");
  CHECK(found.how == judgement::warning);
  CHECK(found.remedy == "roscell doctor --to 10.0.0.5:8420");
}

TEST_CASE("ports that any program may get are reserved by the remedy",
          "[doctor]") {
  const ephemeral_readings usual{{32768, 60999}, {}, ""};
  CHECK(judge_ephemeral(usual, {{8420, 8420}, {32150, 32166}}).how
        == judgement::ok);
  const ephemeral_readings wide{
      {1024, 65000}, parse_port_ranges("80,8420"), "80,8420"};
  const auto found = judge_ephemeral(wide, {{8420, 8420}, {7400, 7649}});
  CHECK(found.how == judgement::warning);
  CHECK(found.remedy
        == "sudo sysctl -w net.ipv4.ip_local_reserved_ports=80,8420,7400-7649");
  const ephemeral_readings kept{
      {1024, 65000}, parse_port_ranges("80,7400-7500,7501-7700"), ""};
  CHECK(judge_ephemeral(kept, {{7400, 7649}}).how == judgement::ok);
  CHECK(judge_ephemeral({}, {{8420, 8420}}).how == judgement::skipped);
}

TEST_CASE("a host with few ports left for ROS 2 programs is told before the "
          "next program is deaf",
          "[doctor]") {
  const auto of_programs = [](unsigned domain, size_t count) {
    const auto all = program_ports(domain);
    return std::set<unsigned>(all.begin(),
                              all.begin() + static_cast<int>(count));
  };
  CHECK(judge_domain(0, of_programs(0, 80)).how == judgement::ok);
  CHECK(judge_domain(0, of_programs(0, 81)).how == judgement::warning);
  CHECK(judge_domain(0, of_programs(0, 100)).how == judgement::warning);
  CHECK(judge_domain(0, of_programs(0, 101)).how == judgement::broken);
  CHECK(judge_domain(1, of_programs(0, 101)).how == judgement::ok);
  // The highest domain has fewer, for the ports end.
  CHECK(program_ports(232).back() == 65534);
  CHECK(judge_domain(232, of_programs(232, 63)).how == judgement::broken);
}

TEST_CASE("the two ports of a program count once", "[doctor]") {
  const auto found = judge_domain(0, {7400, 7410, 7411, 7413, 7414, 7700});
  CHECK_THAT(found.seen, Contains("3 of the 101"));
}

TEST_CASE("bound ports are read from the kernel's table", "[doctor]") {
  const std::string table =
      "  sl  local_address rem_address   st tx_queue rx_queue tr tm->when "
      "retrnsmt   uid  timeout inode ref pointer drops\n"
      " 1097: 0500000A:1CF2 00000000:0000 07 00000000:00000000 00:00000000 "
      "00000000     0        0 31245 2 0000000000000000 0\n"
      " 1099: 0100007F:1CF2 00000000:0000 07 00000000:00000000 00:00000000 "
      "00000000  1000        0 31246 2 0000000000000000 0\n"
      " 1101: 00000000:2E23 00000000:0000 07 00000000:00000000 00:00000000 "
      "00000000     0        0 31247 2 0000000000000000 0\n";
  CHECK(ports_in(table) == std::set<unsigned>{7410, 11811});
  CHECK(ports_in("").empty());
  CHECK(ports_of_domain(232).last == 65535);
  CHECK(public_ports(99).first == 32150);
}
