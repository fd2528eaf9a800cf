#include "actors/edge/trust/identity_place.hpp"

#include "actors/edge/disk/small_file.hpp"

#include <system_error>
#include <utility>

namespace roscell {

namespace {

namespace fs = std::filesystem;

fs::path beside(fs::path file, const char* ending) {
  file += ending;
  return file;
}

std::optional<edge_error> keep_text(const fs::path& file,
                                    const std::string& text) {
  auto why = text.empty() ? std::string{} : write_lasting(file, text);
  if (why.empty())
    return std::nullopt;
  return edge_error{error_code::internal, std::move(why),
                    "check whether its disk has room"};
}

} // namespace

fs::path issuing_file_of(const fs::path& file) {
  return beside(file, ".issuer");
}

fs::path revoked_file_of(const fs::path& file) {
  return beside(file, ".revoked");
}

edge_result<std::optional<own_identity>> read_issuing(const fs::path& file) {
  const auto where = issuing_file_of(file);
  std::error_code problem;
  if (!fs::exists(where, problem))
    return std::optional<own_identity>{};
  auto read = read_identity_file(where);
  if (auto* why = std::get_if<edge_error>(&read))
    return std::move(*why);
  return std::optional{std::get<own_identity>(std::move(read))};
}

std::optional<edge_error> keep_identity(const fs::path& file,
                                        const kept_identity& x) {
  if (auto why = keep_revoked(file, x.revoked))
    return why;
  if (auto why = keep_text(issuing_file_of(file), x.issuing))
    return why;
  return keep_text(file, text_of(x.own));
}

std::optional<edge_error> keep_revoked(const fs::path& file,
                                       const std::string& revoked) {
  return keep_text(revoked_file_of(file), revoked);
}

} // namespace roscell
