#include "actors/edge/trust/certificate.hpp"

#include "actors/edge/io/crypto.hpp"
#include "actors/edge/trust/limits.hpp"
#include "actors/edge/trust/private_key.hpp"

#include <openssl/err.h>
#include <openssl/pem.h>
#include <openssl/x509v3.h>

#include <ctime>
#include <utility>

namespace roscell {

namespace {

using names_owner =
    std::unique_ptr<GENERAL_NAMES, released_by<GENERAL_NAMES_free>>;

/// The one URI among its names, whatever bytes these have; empty: there is
/// none, or there are several.
std::string uri_in(X509* x) {
  const names_owner names{static_cast<GENERAL_NAMES*>(
      X509_get_ext_d2i(x, NID_subject_alt_name, nullptr, nullptr))};
  std::string result;
  for (int i = 0; i < sk_GENERAL_NAME_num(names.get()); ++i) {
    const auto* name = sk_GENERAL_NAME_value(names.get(), i);
    if (name->type != GEN_URI)
      continue;
    if (!result.empty())
      return {};
    const auto* text = name->d.uniformResourceIdentifier;
    result.assign(reinterpret_cast<const char*>(ASN1_STRING_get0_data(text)),
                  static_cast<size_t>(ASN1_STRING_length(text)));
  }
  return result;
}

std::optional<int64_t> seconds_of(const ASN1_TIME* time) {
  std::tm parts{};
  if (ASN1_TIME_to_tm(time, &parts) != 1)
    return std::nullopt;
  return int64_t{::timegm(&parts)};
}

std::string serial_of(X509* x) {
  const number_owner number{
      ASN1_INTEGER_to_BN(X509_get0_serialNumber(x), nullptr)};
  if (!number || BN_is_negative(number.get()) != 0
      || BN_num_bytes(number.get()) > 20)
    return {};
  std::string bytes(static_cast<size_t>(BN_num_bytes(number.get())), '\0');
  BN_bn2bin(number.get(), reinterpret_cast<unsigned char*>(bytes.data()));
  return to_hex(bytes);
}

} // namespace

certificate::certificate(certificate_owner x) : x509_(std::move(x)) {
  // nop
}

std::optional<certificate> certificate::of(certificate_owner x) {
  certificate result{std::move(x)};
  const bool is_read = result.x509_ && result.read();
  forget_openssl_errors();
  return is_read ? std::optional{std::move(result)} : std::nullopt;
}

std::optional<certificate> certificate::from_der(std::string_view bytes) {
  if (bytes.size() > limits::trust::certificate_bytes)
    return std::nullopt;
  const auto* at = reinterpret_cast<const unsigned char*>(bytes.data());
  const auto* end = at + bytes.size();
  certificate_owner x{d2i_X509(nullptr, &at, static_cast<long>(bytes.size()))};
  if (at != end)
    x.reset();
  return of(std::move(x));
}

bool certificate::read() {
  const auto begins = seconds_of(X509_get0_notBefore(get()));
  const auto ends = seconds_of(X509_get0_notAfter(get()));
  serial_ = serial_of(get());
  if (key() == nullptr || !is_site_key(key()) || !begins || !ends
      || serial_.empty())
    return false;
  begins_unix_s_ = *begins;
  ends_unix_s_ = *ends;
  const auto uri = uri_in(get());
  who_ = identity_in(uri);
  site_ = site_in(uri).value_or("");
  return true;
}

std::string certificate::pem() const {
  const auto out = writing();
  if (PEM_write_bio_X509(out.get(), get()) != 1)
    openssl_failed("PEM_write_bio_X509");
  return written_to(out);
}

std::string certificate::digest() const {
  unsigned char bytes[EVP_MAX_MD_SIZE];
  unsigned size = 0;
  if (X509_digest(get(), EVP_sha256(), bytes, &size) != 1)
    openssl_failed("X509_digest");
  return to_hex({reinterpret_cast<const char*>(bytes), size});
}

std::optional<std::vector<certificate>> certificates_in(std::string_view pem,
                                                        size_t most) {
  const auto in = reading(pem.substr(0, limits::trust::identity_bytes));
  std::vector<certificate> result;
  for (;;) {
    certificate_owner x{PEM_read_bio_X509(in.get(), nullptr, nullptr, nullptr)};
    if (!x)
      break;
    auto read = certificate::of(std::move(x));
    if (!read || result.size() == most)
      return std::nullopt;
    result.push_back(std::move(*read));
  }
  // There is always one error: no more begin. Of another one nothing is taken.
  const auto why = ERR_GET_REASON(ERR_peek_last_error());
  forget_openssl_errors();
  if (why != PEM_R_NO_START_LINE)
    return std::nullopt;
  return result;
}

} // namespace roscell
