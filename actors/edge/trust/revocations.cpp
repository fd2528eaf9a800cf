#include "actors/edge/trust/revocations.hpp"

#include "actors/edge/io/crypto.hpp"
#include "actors/edge/io/plain_text.hpp"
#include "actors/edge/trust/limits.hpp"

#include <algorithm>
#include <charconv>
#include <iterator>
#include <utility>

namespace roscell {

namespace {

constexpr std::string_view first_line = "roscell-revoked 1";
constexpr std::string_view number_word = "number ";
constexpr std::string_view signature_word = "signature ";
constexpr std::string_view owner_word = "owner ";
constexpr size_t max_serial_digits = 40;

std::optional<int64_t> number_in(std::string_view text) {
  int64_t result = 0;
  const auto* end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, result);
  return error == std::errc{} && rest == end && result >= 0
             ? std::optional{result}
             : std::nullopt;
}

bool is_serial(std::string_view text) {
  return !text.empty() && text.size() <= max_serial_digits
         && text.find_first_not_of("0123456789abcdef")
                == std::string_view::npos;
}

bool is_owner(std::string_view text) {
  constexpr size_t longest = 64; // See `identity_in`.
  return !text.empty() && text.size() <= longest
         && text.find_first_not_of("0123456789abcdefABCDEF-")
                == std::string_view::npos;
}

/// Takes a line that begins with the word off the front; none: it does not.
std::optional<std::string_view> take_word_line(std::string_view& text,
                                               std::string_view word) {
  if (text.substr(0, word.size()) != word)
    return std::nullopt;
  return take_until(text, '\n').substr(word.size());
}

} // namespace

revocation_list::revocation_list(std::string site) : site_(std::move(site)) {
  // nop
}

bool revocation_list::revokes(const certificate& x) const {
  return revokes(x.serial(), x.who() ? x.who()->uuid : std::string{},
                 x.begins_unix_s());
}

bool revocation_list::revokes(const std::string& serial,
                              const std::string& uuid,
                              int64_t begins_unix_s) const {
  const auto owner = owners_.find(uuid);
  // They begin earlier than they are made.
  return contains(serial)
         || (owner != owners_.end()
             && begins_unix_s + limits::trust::early_s <= owner->second);
}

/// What has ended for good makes it.
bool revocation_list::make_room(int64_t now_unix_s) {
  constexpr auto longest =
      std::max(limits::trust::machine_s, limits::trust::person_s);
  const auto drop = [](auto& all, int64_t before) {
    for (auto i = all.begin(); i != all.end();)
      i = i->second < before ? all.erase(i) : std::next(i);
  };
  drop(serials_, now_unix_s - limits::trust::renewal_s);
  drop(owners_, now_unix_s - limits::trust::renewal_s - longest);
  return serials_.size() + owners_.size() < limits::trust::revoked;
}

bool revocation_list::add(const std::string& serial, int64_t ends_unix_s,
                          int64_t now_unix_s) {
  if (!make_room(now_unix_s) && !contains(serial))
    return false;
  serials_[serial] = ends_unix_s;
  ++number_;
  return true;
}

bool revocation_list::add_owner(const std::string& uuid, int64_t now_unix_s) {
  if (!make_room(now_unix_s) && owners_.count(uuid) == 0)
    return false;
  owners_[uuid] = now_unix_s;
  ++number_;
  return true;
}

std::string revocation_list::text() const {
  std::string result{first_line};
  result += "\nsite " + site_ + "\n" + std::string{number_word}
            + std::to_string(number_) + "\n";
  for (const auto& [serial, ends] : serials_)
    result += serial + " " + std::to_string(ends) + "\n";
  for (const auto& [uuid, at] : owners_)
    result += std::string{owner_word} + uuid + " " + std::to_string(at) + "\n";
  return result;
}

std::string revocation_list::signed_text(const private_key& site_key) const {
  const auto body = text();
  return body + std::string{signature_word} + to_hex(site_key.sign(body))
         + "\n";
}

bool revocation_list::take_line(std::string_view line) {
  if (serials_.size() + owners_.size() >= limits::trust::revoked)
    return false;
  const bool of_owner = line.substr(0, owner_word.size()) == owner_word;
  if (of_owner)
    line.remove_prefix(owner_word.size());
  const auto name = take_until(line, ' ');
  const auto when = number_in(line);
  if (!when || !(of_owner ? is_owner(name) : is_serial(name)))
    return false;
  return (of_owner ? owners_ : serials_).emplace(name, *when).second;
}

std::optional<revocation_list> revocation_list::read(std::string_view text,
                                                     const certificate& site) {
  if (text.empty() || text.size() > limits::trust::revocations_bytes
      || text.back() != '\n')
    return std::nullopt;
  revocation_list result{site.site()};
  auto rest = text;
  if (take_until(rest, '\n') != first_line
      || take_until(rest, '\n') != "site " + site.site())
    return std::nullopt;
  const auto number = take_word_line(rest, number_word);
  const auto known = number ? number_in(*number) : std::nullopt;
  if (!known)
    return std::nullopt;
  result.number_ = *known;
  while (rest.substr(0, signature_word.size()) != signature_word)
    if (rest.empty() || !result.take_line(take_until(rest, '\n')))
      return std::nullopt;
  const auto body = text.substr(0, text.size() - rest.size());
  const auto signature = from_hex(*take_word_line(rest, signature_word));
  // One text for one list, so that nobody else's has the same number.
  if (!rest.empty() || !signature || body != result.text()
      || !is_signed_by(site.key(), body, *signature))
    return std::nullopt;
  return result;
}

} // namespace roscell
