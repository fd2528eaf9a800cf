#include "actors/site/node_identity.hpp"

#include "actors/core/clocks.hpp"
#include "actors/core/edge_failure.hpp"
#include "actors/edge/disk/small_file.hpp"
#include "actors/edge/http/client/site_door.hpp"
#include "actors/edge/trust/identity_place.hpp"
#include "actors/edge/trust/limits.hpp"
#include "actors/edge/trust/site_folder.hpp"
#include "actors/edge/trust/site_identity.hpp"
#include "actors/edge/trust/skill_signature.hpp"
#include "messages/failure.hpp"

#include <system_error>
#include <utility>

namespace roscell {

namespace fs = std::filesystem;

fs::path identity_file_of(const node_config& config) {
  return config.identity_file.empty() ? config.data_dir / "identity.pem"
                                      : config.identity_file;
}

bool has_identity_file(const node_config& config) {
  std::error_code ignored;
  return !config.identity_file.empty()
         || fs::exists(identity_file_of(config), ignored);
}

bool keeps_site(const node_config& config) {
  std::error_code ignored;
  return config.coordinator && config.site_token_file.empty()
         && fs::exists(config.data_dir / "site" / "site.pem", ignored);
}

caf::error issue_own_identity(const node_config& config,
                              const std::string& uuid) {
  auto opened = site_folder::open(config.data_dir / "site");
  if (const auto* why = std::get_if<edge_error>(&opened))
    return to_caf(*why);
  auto& site = std::get<site_folder>(opened);
  constexpr auto role = site_role::coordinator;
  const auto made = site.issue({site.site().site(), role, config.name, uuid},
                               unix_now_ms() / 1000, good_for_of(role));
  if (const auto* why = std::get_if<edge_error>(&made))
    return to_caf(*why);
  if (const auto why = keep_identity(identity_file_of(config),
                                     std::get<kept_identity>(made)))
    return to_caf(*why);
  return caf::none;
}

caf::error take_invitation(const node_config& config, const std::string& uuid) {
  std::error_code ignored;
  const bool in_file = fs::exists(config.invitation, ignored);
  std::string why;
  const auto by =
      read_invitation(in_file ? read_small_file(config.invitation,
                                                limits::trust::invitation_bytes)
                                    .value_or("")
                              : config.invitation,
                      why);
  if (!by)
    return fail(error_code::schema_violation, why, "",
                "--invite takes the line that `roscell site invite` prints, or "
                "the name of a file with it");
  const auto got = enter_site(*by, {config.name, uuid});
  if (const auto* problem = std::get_if<edge_error>(&got))
    return to_caf(*problem);
  if (const auto problem =
          keep_identity(identity_file_of(config), std::get<kept_identity>(got)))
    return to_caf(*problem);
  return caf::none;
}

std::function<std::variant<std::string, failure>(const std::string&,
                                                 const std::string&)>
signature_check(std::shared_ptr<const site_identity> own) {
  return [own = std::move(own)](const std::string& hash,
                                const std::string& signature)
             -> std::variant<std::string, failure> {
    const auto now = own->trust();
    const auto found = check_signature(now.site, signature, hash, now.unix_s);
    if (const auto* why = std::get_if<distrusted>(&found))
      return failure{error_code::unauthorized, why->text, "/signature",
                     why->hint, ""};
    return uri_of(std::get<identity>(found));
  };
}

caf::expected<site_secret> load_identity_of(const node_config& config) {
  const auto file = identity_file_of(config);
  auto read = site_identity::in_file(file);
  if (const auto* why = std::get_if<edge_error>(&read))
    return to_caf(*why);
  auto& own = std::get<std::shared_ptr<site_identity>>(read);
  const auto wanted =
      config.coordinator ? site_role::coordinator : site_role::node;
  if (own->who().role != wanted)
    return fail(error_code::schema_violation,
                "'" + file.string() + "' is of " + text_of(own->who())
                    + ", and this is a " + to_word(wanted),
                "",
                std::string{"`roscell site issue "} + to_word(wanted)
                    + " NAME` makes one that fits");
  return site_secret::of_identity(std::move(own));
}

} // namespace roscell
