#include "actors/edge/trust/tls_settings.hpp"

#include "actors/edge/trust/limits.hpp"

#include <openssl/x509_vfy.h>

#include <array>
#include <string_view>
#include <utility>

namespace roscell {

namespace {

using trust_function = std::function<trust_now()>;

void free_trust(void*, void* x, CRYPTO_EX_DATA*, int, long, void*) {
  delete static_cast<trust_function*>(x);
}

void free_finding(void*, void* x, CRYPTO_EX_DATA*, int, long, void*) {
  delete static_cast<handshake_finding*>(x);
}

/// Where a context keeps whom it believes.
int trust_slot() {
  static const int slot =
      SSL_CTX_get_ex_new_index(0, nullptr, nullptr, nullptr, free_trust);
  return slot;
}

/// Where a connection keeps what was found out.
int finding_slot() {
  static const int slot =
      SSL_get_ex_new_index(0, nullptr, nullptr, nullptr, free_finding);
  return slot;
}

/// As the other end has sent them; empty: one of them makes no sense.
std::vector<certificate> chain_in(X509_STORE_CTX* shown) {
  std::vector<certificate> result;
  auto* others = X509_STORE_CTX_get0_untrusted(shown);
  for (int i = 0; i < sk_X509_num(others); ++i) {
    auto* x = sk_X509_value(others, i);
    X509_up_ref(x);
    auto read = certificate::of(certificate_owner{x});
    if (!read)
      return {};
    result.push_back(std::move(*read));
  }
  return result;
}

/// What TLS tells the other end of it.
int alert_of(distrust why) {
  switch (why) {
  case distrust::revoked:
    return X509_V_ERR_CERT_REVOKED;
  case distrust::ended:
  case distrust::not_begun:
    return X509_V_ERR_CERT_HAS_EXPIRED;
  case distrust::other_site:
    return X509_V_ERR_DEPTH_ZERO_SELF_SIGNED_CERT; // "unknown CA"
  default:
    return X509_V_ERR_APPLICATION_VERIFICATION;
  }
}

/// What is spoken inside is settled before certificates are shown.
certificate_use use_in(const SSL* connection) {
  const unsigned char* name = nullptr;
  unsigned size = 0;
  SSL_get0_alpn_selected(connection, &name, &size);
  const std::string_view protocol{reinterpret_cast<const char*>(name), size};
  return SSL_is_server(connection) == 1 && protocol == entry_protocol
             ? certificate_use::renewal
             : certificate_use::session;
}

/// In place of OpenSSL's own rules for the web.
int check_shown(X509_STORE_CTX* shown, void*) {
  const auto* connection = static_cast<SSL*>(
      X509_STORE_CTX_get_ex_data(shown, SSL_get_ex_data_X509_STORE_CTX_idx()));
  const auto* trust = static_cast<trust_function*>(
      SSL_CTX_get_ex_data(SSL_get_SSL_CTX(connection), trust_slot()));
  const auto now = (*trust)();
  auto chain = chain_in(shown);
  // Programs that take all of one file show the site's own, too.
  if (chain.size() > 1 && chain.back().digest() == now.site.site.digest())
    chain.pop_back();
  const auto found =
      chain.empty()
          ? std::variant<identity, distrusted>{distrusted{
              distrust::nobody, "its certificate names nobody of a site", {}}}
          : check_chain(now.site, chain, now.unix_s, use_in(connection));
  auto& finding = finding_of(connection);
  if (const auto* who = std::get_if<identity>(&found)) {
    finding.who = *who;
    return 1;
  }
  const auto& why = std::get<distrusted>(found);
  finding.who = why;
  X509_STORE_CTX_set_error(shown, alert_of(why.why));
  return 0;
}

/// Of what the other end speaks the first that is known here.
int choose_protocol(SSL*, const unsigned char** out, unsigned char* out_size,
                    const unsigned char* in, unsigned in_size, void*) {
  const std::string_view offered{reinterpret_cast<const char*>(in), in_size};
  for (size_t i = 0; i < offered.size();) {
    const auto size = static_cast<unsigned char>(offered[i]);
    const auto name = offered.substr(i + 1, size);
    if (name == session_protocol || name == http_protocol
        || name == entry_protocol) {
      *out = in + i + 1;
      *out_size = size;
      return SSL_TLSEXT_ERR_OK;
    }
    i += size + 1U;
  }
  return SSL_TLSEXT_ERR_ALERT_FATAL;
}

} // namespace

tls_settings::tls_settings()
    : context_(SSL_CTX_new(TLS_method()), SSL_CTX_free) {
  auto* x = get();
  expect_done(
      x != nullptr && SSL_CTX_set_min_proto_version(x, TLS1_3_VERSION) == 1
          && SSL_CTX_set1_groups_list(x, "X25519:P-256") == 1
          && SSL_CTX_set_ciphersuites(
                 x, "TLS_AES_128_GCM_SHA256:TLS_CHACHA20_POLY1305_SHA256:"
                    "TLS_AES_256_GCM_SHA384")
                 == 1,
      "TLS 1.3");
  // An idle connection holds no buffers; who was let in once is asked again.
  SSL_CTX_set_mode(x, SSL_MODE_RELEASE_BUFFERS
                          | SSL_MODE_ACCEPT_MOVING_WRITE_BUFFER
                          | SSL_MODE_ENABLE_PARTIAL_WRITE);
  SSL_CTX_set_session_cache_mode(x, SSL_SESS_CACHE_OFF);
  SSL_CTX_set_num_tickets(x, 0);
  SSL_CTX_set_max_cert_list(x, limits::trust::chain
                                   * limits::trust::certificate_bytes);
  SSL_CTX_set_alpn_select_cb(x, choose_protocol, nullptr);
}

tls_settings::tls_settings(const own_identity& own, trust_function trust)
    : tls_settings() {
  auto* x = get();
  expect_done(SSL_CTX_use_certificate(x, own.chain.front().get()) == 1
                  && SSL_CTX_use_PrivateKey(x, own.key.get()) == 1,
              "an identity");
  for (size_t i = 1; i < own.chain.size(); ++i)
    expect_done(SSL_CTX_add1_chain_cert(x, own.chain[i].get()) == 1,
                "its issuer");
  auto kept = std::make_unique<trust_function>(std::move(trust));
  expect_done(SSL_CTX_set_ex_data(x, trust_slot(), kept.get()) == 1,
              "whom it trusts");
  (void)kept.release(); // The context's from here on.
  SSL_CTX_set_cert_verify_callback(x, check_shown, nullptr);
  // A newcomer has no certificate: who that is is asked afterwards.
  SSL_CTX_set_verify(x, SSL_VERIFY_PEER, nullptr);
}

tls_settings tls_settings::of_newcomer() {
  tls_settings result;
  SSL_CTX_set_verify(result.get(), SSL_VERIFY_NONE, nullptr);
  return result;
}

handshake_finding& finding_of(const SSL* connection) {
  auto* known = static_cast<handshake_finding*>(
      SSL_get_ex_data(connection, finding_slot()));
  if (known == nullptr) {
    auto made = std::make_unique<handshake_finding>();
    expect_done(SSL_set_ex_data(const_cast<SSL*>(connection), finding_slot(),
                                made.get())
                    == 1,
                "a finding");
    known = made.release();
  }
  return *known;
}

} // namespace roscell
