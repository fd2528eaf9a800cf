#include "actors/edge/dds/announcement.hpp"

#include "actors/edge/dds/limits.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <set>
#include <tuple>
#include <utility>

namespace roscell {

namespace {

constexpr std::string_view magic = "roscell=";
constexpr std::string_view hex_digits = "0123456789abcdef";

auto as_tuple(const announcement& x) {
  return std::tie(x.protocol_version, x.role, x.node, x.cell, x.session, x.uuid,
                  x.incarnation, x.epoch, x.discovery, x.server, x.cell_uuid);
}

bool is_plain(unsigned char byte) {
  return byte > 0x20 && byte < 0x7f && byte != '%' && byte != ';'
         && byte != '=';
}

void append_pair(std::string& to, std::string_view key,
                 std::string_view value) {
  to.append(key).push_back('=');
  for (unsigned char byte : value) {
    if (is_plain(byte)) {
      to.push_back(static_cast<char>(byte));
    } else {
      to.push_back('%');
      to.push_back(hex_digits[byte >> 4]);
      to.push_back(hex_digits[byte & 15]);
    }
  }
  to.push_back(';');
}

std::optional<std::string> unescape(std::string_view text) {
  std::string result;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '%') {
      result.push_back(text[i]);
      continue;
    }
    unsigned byte = 0;
    const char* first = text.data() + i + 1;
    if (i + 2 >= text.size()
        || std::from_chars(first, first + 2, byte, 16).ptr != first + 2)
      return std::nullopt;
    result.push_back(static_cast<char>(byte));
    i += 2;
  }
  return result;
}

std::string* text_of(announcement& x, std::string_view key) {
  const std::array<std::pair<std::string_view, std::string*>, 8> members{
      {{"roscell", &x.protocol_version},
       {"role", &x.role},
       {"node", &x.node},
       {"cell", &x.cell},
       {"session", &x.session},
       {"uuid", &x.uuid},
       {"discovery", &x.discovery},
       {"cell_uuid", &x.cell_uuid}}};
  for (auto& [name, member] : members)
    if (name == key)
      return member;
  return nullptr;
}

std::int64_t* number_of(announcement& x, std::string_view key) {
  if (key == "incarnation")
    return &x.incarnation;
  if (key == "epoch")
    return &x.epoch;
  return key == "server" ? &x.server : nullptr;
}

bool read_number(std::string_view text, std::int64_t& value) {
  const char* last = text.data() + text.size();
  auto [ptr, ec] = std::from_chars(text.data(), last, value);
  return ec == std::errc{} && ptr == last && value >= 0;
}

/// False when the pair damages the whole.
bool read_pair(announcement& x, std::string_view key, std::string_view raw) {
  auto value = unescape(raw);
  if (!value)
    return false;
  if (auto* number = number_of(x, key))
    return read_number(*value, *number);
  if (auto* member = text_of(x, key))
    *member = std::move(*value);
  return true;
}

} // namespace

bool operator==(const announcement& x, const announcement& y) {
  return as_tuple(x) == as_tuple(y);
}

bool operator!=(const announcement& x, const announcement& y) {
  return !(x == y);
}

std::string encode(const announcement& x) {
  std::string result;
  append_pair(result, "roscell", x.protocol_version);
  append_pair(result, "role", x.role);
  append_pair(result, "node", x.node);
  append_pair(result, "cell", x.cell);
  append_pair(result, "session", x.session);
  append_pair(result, "uuid", x.uuid);
  append_pair(result, "incarnation", std::to_string(x.incarnation));
  if (x.epoch != 0)
    append_pair(result, "epoch", std::to_string(x.epoch));
  if (!x.discovery.empty())
    append_pair(result, "discovery", x.discovery);
  if (x.server != 0)
    append_pair(result, "server", std::to_string(x.server));
  if (!x.cell_uuid.empty())
    append_pair(result, "cell_uuid", x.cell_uuid);
  return result;
}

std::optional<announcement> decode(std::string_view bytes) {
  if (bytes.size() > limits::discovery::announcement_bytes
      || bytes.substr(0, magic.size()) != magic)
    return std::nullopt;
  announcement result;
  result.protocol_version.clear();
  std::set<std::string_view> seen;
  while (!bytes.empty()) {
    auto end = bytes.find(';');
    auto equals = bytes.find('=');
    if (end == std::string_view::npos || equals >= end)
      return std::nullopt;
    auto key = bytes.substr(0, equals);
    if (!seen.insert(key).second
        || !read_pair(result, key, bytes.substr(equals + 1, end - equals - 1)))
      return std::nullopt;
    bytes.remove_prefix(end + 1);
  }
  if (result.protocol_version.empty())
    return std::nullopt;
  return result;
}

namespace {

/// Whether both are about one coordinator, or about one other node.
bool same_subject(const announcement& x, const announcement& y) {
  return x.uuid == y.uuid
         && (x.role == "coordinator") == (y.role == "coordinator");
}

} // namespace

/// What was killed and has started again is there, though its former presence
/// ends only now. What it says is told anew, as an unauthenticated peer may
/// have claimed its UUID for a while.
presence_table::change presence_table::succession(const announcement& former,
                                                  time_point now) {
  const auto heir =
      std::find_if(known_.begin(), known_.end(), [&](const auto& x) {
        return same_subject(x.second.said, former);
      });
  if (heir == known_.end())
    return {true, former};
  heir->second.reported = now;
  return {false, heir->second.said};
}

presence_table::outcome presence_table::remember(const guid_prefix& who,
                                                 const announcement& said,
                                                 time_point now) {
  outcome result;
  const auto i = known_.find(who);
  if (i == known_.end()) {
    if (known_.size() >= limits::unauthenticated_peers::participants)
      return result;
    known_.emplace(who, entry{said, now});
    result.newcomer = true;
    result.changes.push_back({false, said});
    return result;
  }
  auto& x = i->second;
  if (x.said == said
      && now - x.reported < limits::unauthenticated_peers::retelling)
    return result;
  const auto former = std::exchange(x.said, said);
  x.reported = now;
  if (!same_subject(former, said))
    result.changes.push_back(succession(former, now));
  result.changes.push_back({false, said});
  return result;
}

std::vector<presence_table::change>
presence_table::forget(const guid_prefix& who, time_point now) {
  const auto ended = known_.extract(who);
  if (!ended)
    return {};
  return {succession(ended.mapped().said, now)};
}

} // namespace roscell
