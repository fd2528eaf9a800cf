#include "actors/edge/dds/rtps/participant_news.hpp"

#include "actors/edge/dds/rtps/parameter_ids.hpp"
#include "actors/edge/dds/rtps/submessages.hpp"

#include <algorithm>
#include <optional>

namespace roscell {

namespace {

constexpr std::uint32_t participant_writer = 0x000100c2;

/// The participant that a parameter list is about. Leaves `in` behind the list.
std::optional<guid_prefix> subject_in(wire_cursor& in) {
  std::optional<guid_prefix> result;
  while (in.good()) {
    const auto id = in.u16();
    const auto value = in.take(in.u16());
    if (id == parameter_id::sentinel)
      break;
    if ((id == parameter_id::participant_guid || id == parameter_id::key_hash)
        && value.size() >= guid_prefix{}.size()) {
      result.emplace();
      std::copy_n(value.position(), result->size(), result->begin());
    }
  }
  return result;
}

std::optional<participant_news> news_of(const submessage_view& x) {
  auto in = x.body;
  in.skip(8);
  if (x.kind != submessage_kind::data
      || in.big_endian_u32() != participant_writer)
    return std::nullopt;
  in.sequence_number();
  std::optional<guid_prefix> who;
  if ((x.flags & submessage_flag::inline_qos) != 0)
    who = subject_in(in);
  const bool ended = (x.flags & submessage_flag::data) == 0;
  if (!ended && !who) {
    const auto encapsulation = in.big_endian_u32() >> 16;
    in.little_endian(encapsulation == 3); // PL_CDR_LE
    who = subject_in(in);
  }
  if (!who)
    return std::nullopt;
  return participant_news{*who, ended};
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
    if (const auto news = news_of(x))
      result.push_back(*news);
    return true;
  });
  return result;
}

} // namespace roscell
