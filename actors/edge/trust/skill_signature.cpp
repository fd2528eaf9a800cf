#include "actors/edge/trust/skill_signature.hpp"

#include "actors/edge/io/crypto.hpp"
#include "actors/edge/io/plain_text.hpp"
#include "actors/edge/trust/limits.hpp"

namespace roscell {

namespace {

constexpr std::string_view signed_word = "signature ";

/// Nothing else that an identity signs is such a text.
std::string text_about(const std::string& hash) {
  return "roscell build " + hash;
}

distrusted no_signature(const std::string& why) {
  return {distrust::nobody, why, "`roscell skill sign` makes a signature"};
}

} // namespace

std::string sign_build(const own_identity& by, const std::string& hash) {
  std::string result;
  for (const auto& x : by.chain)
    result += x.pem();
  return result + std::string{signed_word}
         + to_hex(by.key.sign(text_about(hash))) + "\n";
}

std::variant<identity, distrusted> check_signature(const site_trust& trust,
                                                   std::string_view signature,
                                                   const std::string& hash,
                                                   int64_t now_unix_s) {
  const auto at = signature.rfind(signed_word);
  if (signature.size() > limits::trust::identity_bytes
      || at == std::string_view::npos || signature.back() != '\n')
    return no_signature("that is no signature of a build");
  const auto chain =
      certificates_in(signature.substr(0, at), limits::trust::chain);
  auto rest = signature.substr(at + signed_word.size());
  const auto bytes = from_hex(take_until(rest, '\n'));
  if (!chain || chain->empty() || !bytes || !rest.empty())
    return no_signature("that is no signature of a build");
  auto found = check_chain(trust, *chain, now_unix_s);
  const auto* who = std::get_if<identity>(&found);
  if (who == nullptr)
    return found;
  if (!is_signed_by(chain->front().key(), text_about(hash), *bytes))
    return no_signature("the signature is of another build, or not of "
                        + text_of(*who));
  if (who->role != site_role::operating)
    return distrusted{distrust::not_allowed,
                      "it was signed by " + text_of(*who)
                          + ", and operators sign skills",
                      {}};
  return found;
}

} // namespace roscell
