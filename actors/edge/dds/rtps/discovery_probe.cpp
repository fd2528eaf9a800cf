#include "actors/edge/dds/rtps/discovery_probe.hpp"

#include "actors/edge/dds/rtps/rtps_messages.hpp"

#include <algorithm>
#include <cstring>
#include <limits>
#include <random>
#include <string_view>

namespace roscell {

namespace {

namespace parameter = parameter_id;

using bytes = message_bytes;

constexpr std::array<std::uint8_t, 4> participant_entity{0, 0, 1, 0xc1};

constexpr std::uint8_t data_submessage = 0x15;

/// A CDR string: its length with the final zero, padded to four bytes.
void put_text(bytes& to, std::string_view text) {
  put(to, static_cast<std::uint32_t>(text.size() + 1));
  put_all(to, text);
  do
    to.push_back(0);
  while (to.size() % 4 != 0);
}

void put_parameter(bytes& to, parameter::value which, const bytes& value) {
  put(to, static_cast<std::uint16_t>(which));
  put(to, static_cast<std::uint16_t>(value.size()));
  put_all(to, value);
}

bytes guid_bytes(const guid_prefix& self,
                 const std::array<std::uint8_t, 4>& entity) {
  bytes result(self.begin(), self.end());
  put_all(result, entity);
  return result;
}

/// A discovery server drops what does not carry this identity.
bytes sample_identity(const guid_prefix& self, std::uint32_t number) {
  bytes result = guid_bytes(self, pdp_writer_entity);
  put_sequence_number(result, number);
  return result;
}

bytes locator(const sockaddr_in& at) {
  bytes result;
  put(result, std::uint32_t{1}); // UDPv4.
  put(result, std::uint32_t{ntohs(at.sin_port)});
  result.resize(result.size() + 12);
  std::array<std::uint8_t, 4> address{};
  std::memcpy(address.data(), &at.sin_addr, address.size());
  put_all(result, address);
  return result;
}

/// What every participant says of itself, up to the sentinel: `type` is what
/// Fast DDS calls CLIENT or SERVER.
bytes participant_data(const guid_prefix& self, const char* type) {
  bytes result{0, 3, 0, 0}; // PL_CDR_LE
  put_parameter(result, parameter::protocol_version, {2, 3, 0, 0});
  put_parameter(result, parameter::vendor_id, {1, 0x0f, 0, 0});
  put_parameter(result, parameter::participant_guid,
                guid_bytes(self, participant_entity));
  // It has a participant announcer (1) and a participant detector (2).
  put_parameter(result, parameter::builtin_endpoint_set, {3, 0, 0, 0});
  bytes value{1, 0, 0, 0}; // One property.
  put_text(value, "PARTICIPANT_TYPE");
  put_text(value, type);
  put_parameter(result, parameter::property_list, value);
  return result;
}

bytes probe_data(const guid_prefix& self, const sockaddr_in& reply_to) {
  auto result = participant_data(self, "CLIENT");
  put_parameter(result, parameter::metatraffic_unicast_locator,
                locator(reply_to));
  bytes value;
  put(value, probe_lease_seconds);
  put(value, std::uint32_t{0});
  put_parameter(result, parameter::lease_duration, value);
  value.clear();
  put_text(value, probe_name);
  put_parameter(result, parameter::entity_name, value);
  put_parameter(result, parameter::sentinel, {});
  return result;
}

bytes server_data(const guid_prefix& self, const std::string& announcement) {
  auto result = participant_data(self, "SERVER");
  bytes value;
  put(value, static_cast<std::uint32_t>(announcement.size()));
  put_all(value, announcement);
  value.resize((value.size() + 3) / 4 * 4);
  put_parameter(result, parameter::user_data, value);
  put_parameter(result, parameter::sentinel, {});
  return result;
}

/// One datagram with one DATA submessage. `flags` are those of RTPS 2.3,
/// 9.4.5.3: 1 little-endian, 2 inline QoS, 4 payload.
bytes data_message(const guid_prefix& self, std::uint8_t flags,
                   std::uint32_t number, const bytes& inline_qos,
                   const bytes& payload) {
  bytes body;
  put(body, std::uint16_t{0});
  put(body, std::uint16_t{16}); // From here to the inline QoS.
  put_all(body, pdp_reader_entity);
  put_all(body, pdp_writer_entity);
  put_sequence_number(body, number);
  put_all(body, inline_qos);
  put_all(body, payload);
  bytes result(rtps_header.begin(), rtps_header.end());
  put_all(result, self);
  result.push_back(data_submessage);
  result.push_back(flags);
  put(result, static_cast<std::uint16_t>(body.size()));
  put_all(result, body);
  return result;
}

} // namespace

std::string to_text(const guid_prefix& prefix) {
  constexpr const char* digits = "0123456789abcdef";
  std::string result;
  for (auto byte : prefix) {
    if (!result.empty())
      result.push_back('.');
    result.push_back(digits[byte >> 4]);
    result.push_back(digits[byte & 15]);
  }
  return result;
}

guid_prefix make_probe_prefix() {
  guid_prefix result{1, 0x0f};
  std::random_device source;
  for (std::size_t i = 2; i < result.size(); ++i)
    result[i] = static_cast<std::uint8_t>(source());
  return result;
}

std::vector<std::uint8_t> probe_question(const guid_prefix& self,
                                         const sockaddr_in& reply_to) {
  bytes qos;
  put_parameter(qos, parameter::related_sample_identity,
                sample_identity(self, 1));
  put_parameter(qos, parameter::sentinel, {});
  return data_message(self, 1 | 2 | 4, 1, qos, probe_data(self, reply_to));
}

std::vector<std::uint8_t> probe_reply(const guid_prefix& server,
                                      const std::string& announcement) {
  return data_message(server, 1 | 4, 1, {}, server_data(server, announcement));
}

std::vector<std::uint8_t> death_notice(const guid_prefix& self,
                                       std::uint32_t number,
                                       const guid_prefix& dead) {
  bytes qos;
  put_parameter(qos, parameter::related_sample_identity,
                sample_identity(self, 0));
  put_parameter(qos, parameter::key_hash, guid_bytes(dead, participant_entity));
  put_parameter(qos, parameter::status_info,
                {0, 0, 0, 3}); // Disposed, unregistered.
  put_parameter(qos, parameter::sentinel, {});
  return data_message(self, 1 | 2, number, qos, {});
}

std::vector<std::uint8_t> probe_farewell(const guid_prefix& self) {
  return death_notice(self, 2, self);
}

std::optional<guid_prefix> probe_answer(const std::uint8_t* datagram,
                                        std::size_t size) {
  guid_prefix result{};
  if (size < rtps_header.size() + result.size()
      || !std::equal(rtps_header.begin(), rtps_header.begin() + 4, datagram))
    return std::nullopt;
  std::copy_n(datagram + rtps_header.size(), result.size(), result.begin());
  return result;
}

std::vector<std::uint8_t> heartbeat_answer(const guid_prefix& self,
                                           std::uint32_t count,
                                           std::uint8_t* datagram,
                                           std::size_t size) {
  constexpr std::int64_t most_bits = 32;
  bool is_for_self = false;
  std::int64_t first = 0;
  std::int64_t last = 0;
  for_each_submessage(datagram, size, [&](const submessage_view& x) {
    auto in = x.body;
    if (x.kind == submessage_kind::info_dst && in.size() >= self.size())
      is_for_self = std::equal(self.begin(), self.end(), in.position());
    if (!is_for_self || x.kind != submessage_kind::heartbeat || !in.skip(4)
        || in.big_endian_u32() != discovery_writer::participants)
      return true;
    first = in.sequence_number();
    last = in.sequence_number();
    return !in.good() || first > last; // There is nothing.
  });
  const auto server = probe_answer(datagram, size);
  if (!server || first < 1 || first > last
      || first > std::numeric_limits<std::uint32_t>::max())
    return {};
  message_bytes result(rtps_header.begin(), rtps_header.end());
  put_all(result, self);
  put_all(result, message_bytes{0x0e, 1, 12, 0}); // INFO_DST
  put_all(result, *server);
  put_all(result, message_bytes{0x06, 1, 28, 0}); // ACKNACK
  put_all(result, pdp_reader_entity);
  put_all(result, pdp_writer_entity);
  put_sequence_number(result, static_cast<std::uint32_t>(first));
  const auto bits = std::min(last - first + 1, most_bits);
  put(result, static_cast<std::uint32_t>(bits));
  put(result, ~std::uint32_t{0} << (most_bits - bits));
  put(result, count);
  return result;
}

std::vector<std::uint8_t> first_heartbeats(const guid_prefix& server) {
  constexpr std::uint8_t heartbeat = 0x07;
  constexpr std::uint8_t flags = 1 | 2; // Little-endian, no answer is wanted.
  constexpr std::uint16_t body_bytes = 28;
  // Of participants, publications, subscriptions and liveliness.
  constexpr std::array<std::array<std::uint8_t, 3>, 4> entities{
      {{0, 1, 0}, {0, 0, 3}, {0, 0, 4}, {0, 2, 0}}};
  message_bytes result(rtps_header.begin(), rtps_header.end());
  put_all(result, server);
  for (const auto& entity : entities) {
    result.push_back(heartbeat);
    result.push_back(flags);
    put(result, body_bytes);
    put_all(result, entity);
    result.push_back(0xc7); // A reader,
    put_all(result, entity);
    result.push_back(0xc2);         // and a writer, with a key.
    put_sequence_number(result, 1); // The first that there is,
    put_sequence_number(result, 0); // and the last.
    put(result, std::uint32_t{1});  // Of its HEARTBEATs.
  }
  return result;
}

} // namespace roscell
