#pragma once

#include "actors/edge/session/site_token.hpp"
#include "messages/failure.hpp"
#include "roscell/node_config.hpp"

#include <caf/error.hpp>
#include <caf/expected.hpp>

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <variant>

/// How a node comes to what it is at its site.
namespace roscell {

/// Where the node's identity is: what the configuration says, else in the data
/// directory, where there need not be one.
std::filesystem::path identity_file_of(const node_config& config);

/// Whether there is one, or has to be.
bool has_identity_file(const node_config& config);

/// Whether the node is a coordinator in whose data directory a site is kept.
bool keeps_site(const node_config& config);

/// Makes such a coordinator an identity of that site, and what makes those of
/// nodes. Errors: those of `site_folder`.
caf::error issue_own_identity(const node_config& config,
                              const std::string& uuid);

/// Gets an identity by the invitation of the configuration, and keeps it there.
/// Waits for the network. Errors: those of `enter_site`, schema_violation (it
/// is no invitation).
caf::error take_invitation(const node_config& config, const std::string& uuid);

/// Says who of the site has signed a build, as it is believed at that moment:
/// see `coordinator_setup`.
std::function<std::variant<std::string, failure>(const std::string& hash,
                                                 const std::string& signature)>
signature_check(std::shared_ptr<const site_identity> own);

/// The identity in that file. Errors: those of `site_identity::in_file`,
/// schema_violation (it is of another role).
caf::expected<site_secret> load_identity_of(const node_config& config);

} // namespace roscell
