#include "actors/edge/trust/identity_file.hpp"

#include "actors/edge/disk/file_rights.hpp"
#include "actors/edge/disk/small_file.hpp"
#include "actors/edge/trust/limits.hpp"

#include <sys/stat.h>

#include <optional>
#include <utility>

namespace roscell {

namespace {

namespace fs = std::filesystem;

constexpr const char* make_one = "`roscell site issue` makes one";

edge_error no_identity(const std::string& why) {
  return {error_code::schema_violation, why, make_one};
}

/// Why it cannot be kept secret; empty: it is.
std::string who_may_read(const fs::path& file) {
  struct stat info {};
  if (::stat(file.c_str(), &info) != 0 || (info.st_mode & 077) == 0)
    return {};
  return "others may read it";
}

} // namespace

std::string text_of(const own_identity& x) {
  auto result = x.key.pem();
  for (const auto& one : x.chain)
    result += one.pem();
  return result + x.site.pem();
}

edge_result<own_identity> read_identity(std::string_view text) {
  if (text.size() > limits::trust::identity_bytes)
    return no_identity("it is longer than an identity can be");
  auto key = private_key::from_pem(text);
  if (!key)
    return no_identity("it has no key of an identity (ECDSA on P-256)");
  auto all = certificates_in(text, limits::trust::chain + 1);
  if (!all || all->size() < 2)
    return no_identity("it has not its own certificate and that of its site");
  auto site = std::move(all->back());
  all->pop_back();
  const auto& mine = all->front();
  if (!mine.who() || site.site() != mine.who()->site)
    return no_identity("its last certificate is not that of its site");
  if (digest_of_key(mine.key()) != digest_of_key(key->get()))
    return no_identity("its key is not that of its certificate");
  return own_identity{std::move(*key), std::move(*all), std::move(site)};
}

edge_result<own_identity> read_identity_file(const fs::path& file) {
  const auto named = [&file](edge_error why) {
    why.message = "'" + file.string() + "': " + why.message;
    return why;
  };
  const auto text = read_small_file(file, limits::trust::identity_bytes);
  if (!text)
    return named({error_code::schema_violation,
                  "there is no identity that could be read", make_one});
  auto others = who_may_change(file);
  if (others.empty())
    others = who_may_read(file);
  if (!others.empty())
    return named({error_code::unauthorized,
                  "an identity is for its user alone, but " + others,
                  "chmod 600 " + file.string()});
  auto result = read_identity(*text);
  if (auto* why = std::get_if<edge_error>(&result))
    return named(std::move(*why));
  return result;
}

} // namespace roscell
