#include "actors/edge/trust/site_folder.hpp"

#include "actors/edge/disk/file_rights.hpp"
#include "actors/edge/disk/small_file.hpp"
#include "actors/edge/io/plain_text.hpp"
#include "actors/edge/trust/limits.hpp"

#include <charconv>
#include <string_view>
#include <utility>

namespace roscell {

namespace {

namespace fs = std::filesystem;

constexpr const char* key_file = "site.key";
constexpr const char* certificate_file = "site.pem";
constexpr const char* issued_file = "issued";
constexpr const char* revoked_file = "revoked";

/// Some hundred bytes each; a site that has made so many is looked after by
/// programs.
constexpr size_t max_issued_bytes = 16 * limits::mib;

std::string line_of(const issued_certificate& x) {
  return x.serial + " " + std::to_string(x.begins_unix_s) + " "
         + std::to_string(x.ends_unix_s) + " " + uri_of(x.who) + "\n";
}

bool read_number(std::string_view text, int64_t& result) {
  const auto* end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, result);
  return error == std::errc{} && rest == end;
}

std::optional<issued_certificate> issued_in(std::string_view line) {
  issued_certificate result;
  result.serial = take_until(line, ' ');
  const bool has_times =
      read_number(take_until(line, ' '), result.begins_unix_s)
      && read_number(take_until(line, ' '), result.ends_unix_s);
  const auto who = identity_in(line);
  if (!has_times || !who)
    return std::nullopt;
  result.who = *who;
  return result;
}

edge_error damaged(const fs::path& file) {
  return {error_code::schema_violation,
          "'" + file.string() + "' is missing or damaged",
          "put back the copy that was made of " + file.parent_path().string()};
}

} // namespace

site_folder::site_folder(fs::path folder, directory_lock lock, private_key key,
                         certificate site)
    : folder_(std::move(folder)), lock_(std::move(lock)), key_(std::move(key)),
      site_(std::move(site)), revoked_(site_.site()) {
  // nop
}

edge_result<site_folder> site_folder::create(const fs::path& folder,
                                             const std::string& site,
                                             int64_t now_unix_s) {
  if (!is_site_name(site))
    return edge_error{error_code::schema_violation,
                      "a site cannot be called '" + site + "'",
                      "1 to 63 small letters, digits and '-', none of these at "
                      "an end"};
  auto lock = directory_lock::take(folder);
  if (auto* why = std::get_if<edge_error>(&lock))
    return *why;
  std::error_code ignored;
  if (fs::exists(folder / certificate_file, ignored)
      || fs::exists(folder / key_file, ignored))
    return edge_error{error_code::conflict,
                      "there is a site in '" + folder.string() + "'",
                      "`roscell site list` shows it; --dir names another "
                      "folder"};
  const auto key = private_key::make();
  site_folder result{folder, std::get<directory_lock>(std::move(lock)), key,
                     make_site(site, key, now_unix_s)};
  // The certificate comes last: with it the site is whole.
  for (const auto& [name, text] :
       {std::pair{key_file, key.pem()},
        {issued_file, std::string{}},
        {revoked_file, result.revoked_.signed_text(key)},
        {certificate_file, result.site_.pem()}})
    if (auto why = result.write(name, text))
      return *why;
  return result;
}

edge_result<site_folder> site_folder::open(const fs::path& folder) {
  std::error_code ignored;
  if (!fs::exists(folder / certificate_file, ignored))
    return edge_error{error_code::schema_violation,
                      "there is no site in '" + folder.string() + "'",
                      "`roscell site create` makes one; --dir names another "
                      "folder"};
  for (const auto* name : {key_file, certificate_file})
    if (auto others = who_may_change(folder / name); !others.empty())
      return edge_error{error_code::unauthorized,
                        "'" + (folder / name).string()
                            + "' is for its user alone, but " + others,
                        "give it to the user who looks after the site"};
  auto lock = directory_lock::take(folder);
  if (auto* why = std::get_if<edge_error>(&lock))
    return *why;
  auto key = private_key::from_pem(
      read_small_file(folder / key_file, limits::trust::key_bytes)
          .value_or(""));
  auto own = certificates_in(
      read_small_file(folder / certificate_file, limits::trust::identity_bytes)
          .value_or(""),
      1);
  if (!own || own->empty() || own->front().site().empty())
    return damaged(folder / certificate_file);
  if (!key || digest_of_key(key->get()) != digest_of_key(own->front().key()))
    return damaged(folder / key_file);
  return site_folder{folder, std::get<directory_lock>(std::move(lock)),
                     std::move(*key), std::move(own->front())}
      .loaded();
}

edge_result<site_folder> site_folder::loaded() && {
  const auto revoked =
      read_small_file(folder_ / revoked_file, limits::trust::revocations_bytes);
  auto list = revocation_list::read(revoked.value_or(""), site_);
  if (!list)
    return damaged(folder_ / revoked_file);
  revoked_ = std::move(*list);
  const auto text = read_small_file(folder_ / issued_file, max_issued_bytes);
  if (!text)
    return damaged(folder_ / issued_file);
  for (std::string_view rest{*text}; !rest.empty();) {
    auto x = issued_in(take_until(rest, '\n'));
    if (!x)
      return damaged(folder_ / issued_file);
    issued_.push_back(std::move(*x));
  }
  return std::move(*this);
}

std::optional<edge_error> site_folder::write(const char* name,
                                             const std::string& text) {
  auto why = write_lasting(folder_ / name, text);
  if (why.empty())
    return std::nullopt;
  return edge_error{error_code::internal, std::move(why),
                    "check whether its disk has room"};
}

edge_result<kept_identity> site_folder::issue(const identity& who,
                                              int64_t now_unix_s,
                                              int64_t good_for_s) {
  auto own = make(who, now_unix_s, good_for_s);
  if (auto* why = std::get_if<edge_error>(&own))
    return *why;
  kept_identity result{
      std::get<own_identity>(std::move(own)), {}, signed_list()};
  if (who.role != site_role::coordinator)
    return result;
  const auto issuing = make({who.site, site_role::issuer, who.name, who.uuid},
                            now_unix_s, good_for_of(site_role::issuer));
  if (const auto* why = std::get_if<edge_error>(&issuing))
    return *why;
  result.issuing = text_of(std::get<own_identity>(issuing));
  return result;
}

edge_result<own_identity>
site_folder::make(const identity& who, int64_t now_unix_s, int64_t good_for_s) {
  const auto key = private_key::make();
  auto made = certify(who, key.get(), now_unix_s, good_for_s);
  if (auto* why = std::get_if<edge_error>(&made))
    return *why;
  return own_identity{key, {std::get<certificate>(std::move(made))}, site_};
}

edge_result<certificate> site_folder::certify(const identity& who,
                                              EVP_PKEY* key, int64_t now_unix_s,
                                              int64_t good_for_s) {
  auto made = make_certificate(who, key, {key_, site_}, now_unix_s, good_for_s);
  issued_.push_back(
      {who, made.serial(), made.begins_unix_s(), made.ends_unix_s()});
  std::string all;
  for (const auto& x : issued_)
    all += line_of(x);
  if (auto why = write(issued_file, all)) {
    issued_.pop_back();
    return *why;
  }
  return made;
}

std::optional<edge_error> site_folder::revoke(const issued_certificate& x,
                                              int64_t now_unix_s) {
  if (revoked_.contains(x.serial))
    return edge_error{error_code::conflict,
                      "the certificate " + x.serial + " of " + text_of(x.who)
                          + " is revoked already",
                      {}};
  auto longer = revoked_;
  const bool has_room = longer.add(x.serial, x.ends_unix_s, now_unix_s);
  return take_list(std::move(longer), has_room);
}

std::optional<edge_error> site_folder::revoke_owner(const std::string& uuid,
                                                    int64_t now_unix_s) {
  auto longer = revoked_;
  const bool has_room = longer.add_owner(uuid, now_unix_s);
  return take_list(std::move(longer), has_room);
}

std::optional<edge_error> site_folder::take_list(revocation_list longer,
                                                 bool has_room) {
  if (!has_room)
    return edge_error{error_code::conflict,
                      "a site can have "
                          + std::to_string(limits::trust::revoked)
                          + " revoked certificates, and has them",
                      "`roscell site rotate` begins a new list"};
  if (auto why = write(revoked_file, longer.signed_text(key_)))
    return why;
  revoked_ = std::move(longer);
  return std::nullopt;
}

} // namespace roscell
