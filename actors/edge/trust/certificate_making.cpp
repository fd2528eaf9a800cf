#include "actors/edge/trust/certificate_making.hpp"

#include "actors/edge/io/crypto.hpp"
#include "actors/edge/trust/limits.hpp"

#include <openssl/x509v3.h>

#include <algorithm>
#include <utility>

namespace roscell {

namespace {

using extension_owner =
    std::unique_ptr<X509_EXTENSION, released_by<X509_EXTENSION_free>>;

constexpr size_t serial_bytes = 16;

void set_serial(X509* x) {
  auto bytes = random_bytes(serial_bytes);
  bytes[0] = static_cast<char>(bytes[0] & 0x7f); // A positive number,
  bytes[0] = static_cast<char>(bytes[0] | 0x40); // always as long.
  const number_owner number{
      BN_bin2bn(reinterpret_cast<const unsigned char*>(bytes.data()),
                static_cast<int>(bytes.size()), nullptr)};
  expect_done(number
                  && BN_to_ASN1_INTEGER(number.get(), X509_get_serialNumber(x))
                         != nullptr,
              "a serial");
}

/// For people: a program reads the URI among the other names.
void set_common_name(X509* x, const std::string& text) {
  const auto* bytes = reinterpret_cast<const unsigned char*>(text.data());
  // X.520 has no longer one.
  const auto size = static_cast<int>(std::min<size_t>(text.size(), 64));
  expect_done(X509_NAME_add_entry_by_NID(X509_get_subject_name(x),
                                         NID_commonName, MBSTRING_UTF8, bytes,
                                         size, -1, 0)
                  == 1,
              "a name");
}

void set_times(X509* x, int64_t begin, int64_t end) {
  expect_done(
      ASN1_TIME_set(X509_getm_notBefore(x), static_cast<time_t>(begin))
              != nullptr
          && ASN1_TIME_set(X509_getm_notAfter(x), static_cast<time_t>(end))
                 != nullptr,
      "its times");
}

/// @param value in OpenSSL's own short language, which knows no text of others:
/// names are checked before.
void add_extension(X509* x, X509* signer, int nid, const std::string& value) {
  X509V3_CTX context;
  X509V3_set_ctx(&context, signer, x, nullptr, nullptr, 0);
  const extension_owner made{
      X509V3_EXT_conf_nid(nullptr, &context, nid, value.c_str())};
  expect_done(made && X509_add_ext(x, made.get(), -1) == 1, "an extension");
}

struct draft {
  std::string common_name;
  std::string names; ///< As OpenSSL's configuration has them.
  EVP_PKEY* key = nullptr;
  int64_t begin = 0;
  int64_t end = 0;
  bool signs = false;
};

void add_uses(X509* x, X509* signer, bool signs) {
  add_extension(x, signer, NID_basic_constraints,
                signs ? "critical,CA:TRUE" : "critical,CA:FALSE");
  add_extension(x, signer, NID_key_usage,
                signs ? "critical,keyCertSign,digitalSignature"
                      : "critical,digitalSignature");
  if (!signs)
    add_extension(x, signer, NID_ext_key_usage, "serverAuth,clientAuth");
}

certificate make(const draft& what, const private_key& key, X509* signer) {
  certificate_owner x{X509_new()};
  expect_done(x && X509_set_version(x.get(), X509_VERSION_3) == 1, "X509_new");
  auto* issuer = signer == nullptr ? x.get() : signer;
  set_serial(x.get());
  set_common_name(x.get(), what.common_name);
  set_times(x.get(), what.begin, what.end);
  expect_done(
      X509_set_pubkey(x.get(), what.key) == 1
          && X509_set_issuer_name(x.get(), X509_get_subject_name(issuer)) == 1,
      "its key");
  add_extension(x.get(), issuer, NID_subject_key_identifier, "hash");
  if (signer != nullptr)
    add_extension(x.get(), issuer, NID_authority_key_identifier, "keyid");
  add_uses(x.get(), issuer, what.signs);
  add_extension(x.get(), issuer, NID_subject_alt_name, what.names);
  expect_done(X509_sign(x.get(), key.get(), EVP_sha256()) != 0, "X509_sign");
  auto result = certificate::of(std::move(x));
  expect_done(result.has_value(), "reading what was made");
  return *result;
}

} // namespace

certificate make_site(const std::string& site, const private_key& key,
                      int64_t now_unix_s) {
  using namespace limits::trust;
  draft what;
  what.common_name = "site " + site;
  what.names = "URI:" + uri_of_site(site);
  what.key = key.get();
  what.begin = now_unix_s - early_s;
  what.end = now_unix_s + site_s;
  what.signs = true;
  return make(what, key, nullptr);
}

certificate make_certificate(const identity& who, EVP_PKEY* key,
                             const signer& by, int64_t now_unix_s,
                             int64_t good_for_s) {
  // OpenSSL reads its names in a language of its own.
  expect_done(identity_in(uri_of(who)).has_value(), "a name");
  draft what;
  what.common_name = std::string{to_word(who.role)} + " " + who.name;
  what.names = "URI:" + uri_of(who) + ",DNS:" + dns_name_of(who);
  what.key = key;
  what.begin = now_unix_s - limits::trust::early_s;
  what.end = std::min(now_unix_s + good_for_s, by.mine.ends_unix_s());
  what.signs = who.role == site_role::issuer;
  return make(what, by.key, by.mine.get());
}

int64_t good_for_of(site_role role) {
  using namespace limits::trust;
  switch (role) {
  case site_role::issuer:
    return issuer_s;
  case site_role::operating:
  case site_role::viewer:
    return person_s;
  default:
    return machine_s;
  }
}

} // namespace roscell
