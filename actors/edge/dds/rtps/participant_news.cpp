#include "actors/edge/dds/rtps/participant_news.hpp"

#include "actors/edge/dds/rtps/discovery_probe.hpp"
#include "actors/edge/dds/rtps/rtps_messages.hpp"

#include <algorithm>
#include <optional>

namespace roscell {

namespace {

/// Of a DATA: flags, the distance to the inline QoS, reader and writer.
constexpr std::size_t before_number = 12;

/// Calls `visit(id, value)` for the parameters of a list. Leaves `in` behind
/// the list, or bad where it has no end.
template <class Visit>
void for_each_parameter(wire_cursor& in, Visit visit) {
  while (in.good()) {
    const auto id = in.u16();
    const auto value = in.take(in.u16());
    if (id == parameter_id::sentinel || !in.good())
      return;
    visit(id, value);
  }
}

/// The participant that a parameter list is about. Leaves `in` behind the list.
std::optional<guid_prefix> subject_in(wire_cursor& in) {
  std::optional<guid_prefix> result;
  for_each_parameter(in, [&result](std::uint16_t id, const wire_cursor& value) {
    if ((id == parameter_id::participant_guid
         || id == parameter_id::endpoint_guid || id == parameter_id::key_hash)
        && value.size() >= guid_prefix{}.size()) {
      result.emplace();
      std::copy_n(value.position(), result->size(), result->begin());
    }
  });
  return result;
}

/// A CDR string or sequence of bytes: its length, then as many.
std::string counted_bytes(wire_cursor in) {
  const auto bytes = in.take(in.u32());
  return {bytes.position(), bytes.position() + bytes.size()};
}

/// Of the participant whose parameter list is there.
own_announcement words_in(wire_cursor in) {
  own_announcement result;
  for_each_parameter(in, [&result](std::uint16_t id, const wire_cursor& value) {
    if (id == parameter_id::user_data)
      result.announcement = counted_bytes(value);
    else if (id == parameter_id::entity_name)
      result.name = counted_bytes(value);
  });
  result.name.erase(std::find(result.name.begin(), result.name.end(), '\0'),
                    result.name.end());
  return result;
}

/// Leaves `in`, which is behind the inline QoS, at the list of a payload.
void enter_payload(wire_cursor& in) {
  const auto encapsulation = in.big_endian_u32() >> 16;
  in.little_endian(encapsulation == 3); // PL_CDR_LE
}

/// The entity that has written a DATA; 0: it is none.
std::uint32_t writer_of(const submessage_view& x) {
  auto in = x.body;
  in.skip(8);
  return x.kind == submessage_kind::data ? in.big_endian_u32() : 0;
}

/// Whose participant, reader or writer a DATA of discovery is about.
std::optional<participant_news> news_of(const submessage_view& x) {
  auto in = x.body;
  in.skip(before_number);
  in.sequence_number();
  std::optional<guid_prefix> who;
  if ((x.flags & submessage_flag::inline_qos) != 0)
    who = subject_in(in);
  const bool ended = (x.flags & submessage_flag::data) == 0;
  if (!ended && !who) {
    enter_payload(in);
    who = subject_in(in);
  }
  if (!who)
    return std::nullopt;
  return participant_news{*who, ended};
}

bool is_of_discovery(std::uint32_t writer) {
  return writer == discovery_writer::participants
         || writer == discovery_writer::publications
         || writer == discovery_writer::subscriptions;
}

/// The header of a submessage whose body begins at `body`.
void put_header(std::uint8_t* body, submessage_kind kind, bool little,
                std::size_t bytes) {
  body[-4] = static_cast<std::uint8_t>(kind);
  body[-3] = little ? submessage_flag::little_endian : 0;
  body[little ? -2 : -1] = static_cast<std::uint8_t>(bytes);
  body[little ? -1 : -2] = static_cast<std::uint8_t>(bytes >> 8);
}

/// Turns a DATA into a GAP (RTPS 2.3, 9.4.5.5) that skips its number, and a PAD
/// for the room that is left.
void skip_number(const submessage_view& data) {
  constexpr std::size_t gap_bytes = 28;
  constexpr std::size_t header_bytes = 4;
  constexpr std::size_t before_endpoints = 4;
  constexpr std::size_t endpoints_bytes = 8;
  constexpr std::size_t number_bytes = 8;
  auto* const body = data.body.position();
  const auto room = data.body.size();
  if (room != gap_bytes && room < gap_bytes + header_bytes)
    return;
  auto after = data.body;
  after.skip(before_endpoints + endpoints_bytes);
  const auto next = after.sequence_number() + 1;
  std::copy_n(body + before_endpoints, endpoints_bytes + number_bytes, body);
  const bool little = data.body.is_little_endian();
  auto base = data.body;
  base.skip(endpoints_bytes + number_bytes);
  put_number(base, next);
  base.skip(number_bytes);
  put_word(base, 0); // No number behind it is skipped.
  put_header(body, submessage_kind::gap, little, gap_bytes);
  if (room > gap_bytes)
    put_header(body + gap_bytes + header_bytes, submessage_kind::pad, little,
               room - gap_bytes - header_bytes);
}

} // namespace

guid_prefix sender_of(const std::uint8_t* message) {
  guid_prefix result{};
  std::copy_n(message + rtps_sender_at, result.size(), result.begin());
  return result;
}

std::vector<participant_news> participants_in(std::uint8_t* message,
                                              std::size_t size) {
  std::vector<participant_news> result;
  for_each_submessage(message, size, [&result](const submessage_view& x) {
    if (writer_of(x) != discovery_writer::participants)
      return true;
    if (const auto news = news_of(x))
      result.push_back(*news);
    return true;
  });
  return result;
}

bool introduces_itself(std::uint8_t* message, std::size_t size) {
  const auto news = participants_in(message, size);
  const auto sender = sender_of(message);
  return std::any_of(news.begin(), news.end(), [&sender](const auto& x) {
    return x.who == sender && !x.ended;
  });
}

std::optional<guid_prefix> introduced_to(std::uint8_t* message,
                                         std::size_t size) {
  std::optional<guid_prefix> result;
  int data = 0;
  const bool sound =
      for_each_submessage(message, size, [&](const submessage_view& x) {
        if (x.kind == submessage_kind::info_dst
            && x.body.size() >= guid_prefix{}.size())
          std::copy_n(x.body.position(), guid_prefix{}.size(),
                      result.emplace().begin());
        else if (x.kind == submessage_kind::data)
          ++data;
        return x.kind != submessage_kind::acknack
               && x.kind != submessage_kind::gap;
      });
  if (!sound || data != 1 || !introduces_itself(message, size))
    return std::nullopt;
  return result;
}

std::optional<own_announcement> own_announcement_in(std::uint8_t* message,
                                                    std::size_t size) {
  const auto sender = probe_answer(message, size);
  std::optional<own_announcement> result;
  if (!sender)
    return result;
  for_each_submessage(message, size, [&](const submessage_view& x) {
    auto in = x.body;
    if (writer_of(x) != discovery_writer::participants
        || (x.flags & submessage_flag::data) == 0 || !in.skip(before_number))
      return true;
    in.sequence_number();
    if ((x.flags & submessage_flag::inline_qos) != 0)
      subject_in(in);
    enter_payload(in);
    const auto list = in;
    if (subject_in(in) == sender && in.good())
      result = words_in(list);
    return !result;
  });
  return result;
}

void raise_own_news(std::uint8_t* message, std::size_t size, std::int64_t by) {
  const auto sender = sender_of(message);
  for_each_submessage(message, size, [&](const submessage_view& x) {
    if (writer_of(x) != discovery_writer::participants
        || (x.flags & submessage_flag::inline_qos) == 0)
      return true;
    const auto news = news_of(x);
    if (!news || news->ended || news->who != sender)
      return true;
    auto qos = x.body;
    qos.skip(before_number);
    qos.sequence_number();
    raise_identity(qos, sender, by);
    return true;
  });
}

void leave_out(std::uint8_t* message, std::size_t size,
               const unwanted_news& is_unwanted) {
  std::optional<guid_prefix> to;
  for_each_submessage(message, size, [&](const submessage_view& x) {
    if (x.kind == submessage_kind::info_dst
        && x.body.size() >= guid_prefix{}.size())
      std::copy_n(x.body.position(), guid_prefix{}.size(),
                  to.emplace().begin());
    if (!to || !is_of_discovery(writer_of(x)))
      return true;
    const auto news = news_of(x);
    if (news && !news->ended && is_unwanted(*to, news->who))
      skip_number(x);
    return true;
  });
}

} // namespace roscell
