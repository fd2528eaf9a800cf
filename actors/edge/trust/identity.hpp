#pragma once

#include <optional>
#include <string>
#include <string_view>

/// Who somebody is at a site, as his certificate says it.
namespace roscell {

/// What somebody is there for, and so what he may do.
enum class site_role {
  node,
  coordinator,
  operating, ///< "operator": a person who changes things,
  viewer,    ///< and one who only looks.
  issuer,    ///< Signs certificates of nodes for the site.
};

/// "node", "coordinator", "operator", "viewer", "issuer".
const char* to_word(site_role role);
std::optional<site_role> role_from(std::string_view word);

struct identity {
  std::string site; ///< A name of small letters, digits and '-'.
  site_role role = site_role::node;
  std::string name; ///< Of the node or the person.
  std::string uuid;

  friend bool operator==(const identity& a, const identity& b) {
    return a.site == b.site && a.role == b.role && a.name == b.name
           && a.uuid == b.uuid;
  }
};

/// Whether a site can be called so: 1 to 63 small letters, digits and '-', none
/// of these at an end. It is part of DNS names.
bool is_site_name(std::string_view text);

/// A random UUID, version 4 of RFC 4122.
std::string make_uuid();

/// The form of SPIFFE, which other tools read:
/// spiffe://SITE/ROLE/NAME/UUID
std::string uri_of(const identity& x);

/// None for what is no such URI, whatever it is.
std::optional<identity> identity_in(std::string_view uri);

/// The URI that a site itself has: spiffe://SITE
std::string uri_of_site(std::string_view site);
std::optional<std::string> site_in(std::string_view uri);

/// The name in DNS that its certificate has beside the URI, for programs that
/// want one: NAME.SITE.roscell.internal, in small letters, with '-' for what
/// DNS does not have.
std::string dns_name_of(const identity& x);

/// "node 'arm' of site 'hall'".
std::string text_of(const identity& x);

} // namespace roscell
