#include "actors/edge/trust/tls_engine.hpp"

#include <openssl/err.h>

#include <stdexcept>
#include <utility>

namespace roscell {

namespace {

constexpr size_t exported_bytes = 32;

int size_of(std::string_view bytes) {
  return static_cast<int>(bytes.size());
}

/// "\x09roscell/1", as ALPN has it.
std::string offer_of(const char* protocol) {
  const std::string name{protocol};
  return std::string(1, static_cast<char>(name.size())) + name;
}

/// What OpenSSL says of the last failure, without its numbers.
std::string reason_of(unsigned long code) {
  const char* text = ERR_reason_error_string(code);
  return text == nullptr ? "the connection was broken off" : text;
}

} // namespace

tls_engine::tls_engine(const tls_settings& settings, role as,
                       const char* protocol)
    : ssl_(SSL_new(settings.get())), incoming_(BIO_new(BIO_s_mem())),
      outgoing_(BIO_new(BIO_s_mem())) {
  if (!ssl_ || incoming_ == nullptr || outgoing_ == nullptr)
    openssl_failed("SSL_new");
  SSL_set_bio(ssl_.get(), incoming_, outgoing_);
  // What has not come yet is no end.
  BIO_set_mem_eof_return(incoming_, -1);
  if (as == role::accepts) {
    SSL_set_accept_state(ssl_.get());
    return;
  }
  SSL_set_connect_state(ssl_.get());
  const auto offer = offer_of(protocol);
  if (SSL_set_alpn_protos(ssl_.get(),
                          reinterpret_cast<const unsigned char*>(offer.data()),
                          static_cast<unsigned>(offer.size()))
      != 0)
    openssl_failed("SSL_set_alpn_protos");
  shake_hands();
}

void tls_engine::take(std::string_view bytes) {
  if (problem_ || bytes.empty())
    return;
  if (!open_ && (taken_ += bytes.size()) > max_handshake_bytes)
    return fail({distrust::too_long,
                 "its handshake is longer than "
                     + std::to_string(max_handshake_bytes) + " bytes",
                 {}});
  if (BIO_write(incoming_, bytes.data(), size_of(bytes)) != size_of(bytes))
    openssl_failed("BIO_write");
  if (!open_)
    shake_hands();
}

std::string tls_engine::give() {
  std::string result(BIO_ctrl_pending(outgoing_), '\0');
  if (!result.empty()
      && BIO_read(outgoing_, result.data(), size_of(result)) != size_of(result))
    openssl_failed("BIO_read");
  return result;
}

void tls_engine::shake_hands() {
  ERR_clear_error();
  const auto result = SSL_do_handshake(ssl_.get());
  open_ = result == 1;
  if (!open_ && SSL_get_error(ssl_.get(), result) != SSL_ERROR_WANT_READ)
    fail();
}

/// What the check of its certificate has found says more than OpenSSL does.
void tls_engine::fail() {
  const auto& finding = finding_of(ssl_.get()).who;
  if (const auto* why = std::get_if<distrusted>(&finding))
    return fail(*why);
  fail({distrust::no_certificate,
        "TLS 1.3 has failed: " + reason_of(ERR_peek_last_error()),
        {}});
}

void tls_engine::fail(distrusted why) {
  forget_openssl_errors();
  open_ = false;
  problem_ = std::move(why);
}

std::optional<identity> tls_engine::peer() const {
  const auto* who = std::get_if<identity>(&finding_of(ssl_.get()).who);
  return open_ && who != nullptr ? std::optional{*who} : std::nullopt;
}

std::vector<certificate> tls_engine::peer_chain() const {
  std::vector<certificate> result;
  const auto add = [&result](X509* x) {
    X509_up_ref(x);
    if (auto read = certificate::of(certificate_owner{x}))
      result.push_back(std::move(*read));
  };
  auto* shown = SSL_get_peer_cert_chain(ssl_.get());
  // Of one who connects the first of these is not in the list.
  if (SSL_is_server(ssl_.get()) == 1)
    if (auto* own = SSL_get0_peer_certificate(ssl_.get()))
      add(own);
  for (int i = 0; i < sk_X509_num(shown); ++i)
    add(sk_X509_value(shown, i));
  return result;
}

std::string tls_engine::protocol() const {
  const unsigned char* name = nullptr;
  unsigned size = 0;
  SSL_get0_alpn_selected(ssl_.get(), &name, &size);
  return {reinterpret_cast<const char*>(name), size};
}

std::string tls_engine::read(size_t most) {
  if (!open_ || problem_)
    return {};
  ERR_clear_error();
  std::string result(most, '\0');
  const auto size = SSL_read(ssl_.get(), result.data(), size_of(result));
  result.resize(size > 0 ? static_cast<size_t>(size) : 0);
  if (size > 0)
    return result;
  const auto why = SSL_get_error(ssl_.get(), size);
  if (why == SSL_ERROR_ZERO_RETURN)
    ended_ = true;
  else if (why != SSL_ERROR_WANT_READ)
    fail();
  return result;
}

/// Into memory all of it goes at once, in records of 16 KiB.
void tls_engine::write(std::string_view bytes) {
  while (open_ && !problem_ && !bytes.empty()) {
    ERR_clear_error();
    const auto size = SSL_write(ssl_.get(), bytes.data(), size_of(bytes));
    if (size <= 0)
      return fail();
    bytes.remove_prefix(static_cast<size_t>(size));
  }
}

void tls_engine::close() {
  if (open_ && !problem_)
    SSL_shutdown(ssl_.get());
  forget_openssl_errors();
}

std::string tls_engine::exported(std::string_view label) const {
  std::string result(exported_bytes, '\0');
  if (!open_
      || SSL_export_keying_material(
             ssl_.get(), reinterpret_cast<unsigned char*>(result.data()),
             result.size(), label.data(), label.size(), nullptr, 0, 0)
             != 1)
    openssl_failed("SSL_export_keying_material");
  return result;
}

} // namespace roscell
