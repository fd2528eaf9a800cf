#include "actors/edge/trust/chain_check.hpp"

#include "actors/edge/trust/limits.hpp"

#include <openssl/x509_vfy.h>

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

namespace roscell {

namespace {

using store_owner = std::unique_ptr<X509_STORE, released_by<X509_STORE_free>>;
using context_owner =
    std::unique_ptr<X509_STORE_CTX, released_by<X509_STORE_CTX_free>>;

void release_names_only(STACK_OF(X509) * x) {
  sk_X509_free(x);
}

using stack_owner =
    std::unique_ptr<STACK_OF(X509), released_by<release_names_only>>;

constexpr std::array<std::pair<distrust, const char*>, 8> distrust_words{{
    {distrust::no_certificate, "no_certificate"},
    {distrust::too_long, "too_long"},
    {distrust::nobody, "nobody"},
    {distrust::other_site, "other_site"},
    {distrust::not_allowed, "not_allowed"},
    {distrust::revoked, "revoked"},
    {distrust::ended, "ended"},
    {distrust::not_begun, "not_begun"},
}};

using verdict = std::optional<distrusted>;

verdict check_names(const site_trust& trust,
                    const std::vector<certificate>& chain) {
  if (chain.empty())
    return distrusted{distrust::no_certificate, "it shows no certificate",
                      "`roscell site invite` lets a node in"};
  if (chain.size() > limits::trust::chain)
    return distrusted{distrust::too_long,
                      "it shows " + std::to_string(chain.size())
                          + " certificates",
                      "its own, and that of its issuer, are enough"};
  const auto& who = chain.front().who();
  if (!who)
    return distrusted{
        distrust::nobody, "its certificate names nobody of a site", {}};
  const auto& site = trust.site.site();
  const auto is_of_site = [&](const certificate& x) {
    return x.who() && x.who()->site == site;
  };
  if (!std::all_of(chain.begin(), chain.end(), is_of_site))
    return distrusted{distrust::other_site,
                      "it is of site '" + who->site + "', this is '" + site
                          + "'",
                      "only what has an identity of this site is let in"};
  return std::nullopt;
}

/// An issuer signs for nodes, and is nobody itself.
verdict check_roles(const std::vector<certificate>& chain) {
  const auto& who = *chain.front().who();
  const bool is_signed_by_site = chain.size() == 1;
  if (who.role != site_role::issuer
      && (is_signed_by_site
          || (chain[1].who()->role == site_role::issuer
              && who.role == site_role::node)))
    return std::nullopt;
  return distrusted{distrust::not_allowed,
                    "the certificate of " + text_of(who)
                        + " was not signed by who may do so",
                    {}};
}

/// Only that each has signed the next one: times are another matter.
bool are_signed(const site_trust& trust,
                const std::vector<certificate>& chain) {
  const store_owner store{X509_STORE_new()};
  const context_owner context{X509_STORE_CTX_new()};
  const stack_owner others{sk_X509_new_null()};
  if (!store || !context || !others
      || X509_STORE_add_cert(store.get(), trust.site.get()) != 1)
    openssl_failed("X509_STORE_add_cert");
  for (size_t i = 1; i < chain.size(); ++i)
    sk_X509_push(others.get(), chain[i].get());
  if (X509_STORE_CTX_init(context.get(), store.get(), chain.front().get(),
                          others.get())
      != 1)
    openssl_failed("X509_STORE_CTX_init");
  auto* rules = X509_STORE_CTX_get0_param(context.get());
  X509_VERIFY_PARAM_set_flags(rules, X509_V_FLAG_X509_STRICT
                                         | X509_V_FLAG_NO_CHECK_TIME);
  X509_VERIFY_PARAM_set_depth(rules, static_cast<int>(chain.size()) - 1);
  const bool result = X509_verify_cert(context.get()) == 1;
  forget_openssl_errors();
  return result;
}

verdict check_revoked(const site_trust& trust,
                      const std::vector<certificate>& chain) {
  for (const auto& x : chain)
    if (trust.revoked && trust.revoked->revokes(x))
      return distrusted{
          distrust::revoked,
          "the certificate of " + text_of(*x.who()) + " was revoked",
          "if that is no longer so, `roscell site invite` lets it "
          "in anew"};
  return std::nullopt;
}

verdict check_times(const std::vector<certificate>& chain, int64_t now,
                    certificate_use use) {
  const auto grace =
      use == certificate_use::renewal ? limits::trust::renewal_s : 0;
  for (const auto& x : chain) {
    if (now < x.begins_unix_s() - limits::trust::early_s)
      return distrusted{distrust::not_begun,
                        "the certificate of " + text_of(*x.who())
                            + " is of a time that has not come",
                        "set the clock of this host"};
    if (now > x.ends_unix_s() + grace)
      return distrusted{distrust::ended,
                        "the certificate of " + text_of(*x.who())
                            + " has ended, by the clock of this host",
                        use == certificate_use::renewal
                            ? "`roscell site invite` lets it in anew"
                            : "a node renews its own when it finds a "
                              "coordinator"};
  }
  return std::nullopt;
}

} // namespace

const char* to_word(distrust why) {
  for (const auto& [known, word] : distrust_words)
    if (known == why)
      return word;
  return "";
}

std::variant<identity, distrusted>
check_chain(const site_trust& trust, const std::vector<certificate>& chain,
            int64_t now_unix_s, certificate_use use) {
  if (auto why = check_names(trust, chain))
    return *why;
  if (!are_signed(trust, chain))
    return distrusted{distrust::other_site,
                      "its certificate is of another site that is called '"
                          + trust.site.site() + "', too",
                      "only what has an identity of this site is let in"};
  if (auto why = check_roles(chain))
    return *why;
  if (auto why = check_revoked(trust, chain))
    return *why;
  if (auto why = check_times(chain, now_unix_s, use))
    return *why;
  return *chain.front().who();
}

int64_t trusted_now(int64_t clock_unix_s, int64_t known_unix_s,
                    int64_t own_begin_unix_s) {
  // When this program cannot have been built yet.
  constexpr int64_t first_version_unix_s = 1'764'000'000;
  return std::max(std::max(clock_unix_s, known_unix_s),
                  std::max(own_begin_unix_s, first_version_unix_s));
}

} // namespace roscell
