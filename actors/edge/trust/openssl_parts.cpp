#include "actors/edge/trust/openssl_parts.hpp"

#include <openssl/err.h>

#include <stdexcept>

namespace roscell {

bio_owner reading(std::string_view bytes) {
  bio_owner result{
      BIO_new_mem_buf(bytes.data(), static_cast<int>(bytes.size()))};
  if (!result)
    openssl_failed("BIO_new_mem_buf");
  return result;
}

bio_owner writing() {
  bio_owner result{BIO_new(BIO_s_mem())};
  if (!result)
    openssl_failed("BIO_new");
  return result;
}

std::string written_to(const bio_owner& bio) {
  char* bytes = nullptr;
  const auto size = BIO_get_mem_data(bio.get(), &bytes);
  return {bytes, static_cast<size_t>(size)};
}

void openssl_failed(const char* what) {
  forget_openssl_errors();
  throw std::runtime_error(std::string{"libcrypto failed at "} + what);
}

void expect_done(bool done, const char* what) {
  if (!done)
    openssl_failed(what);
}

void forget_openssl_errors() {
  ERR_clear_error();
}

} // namespace roscell
