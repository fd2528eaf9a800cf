#include "actors/site/issued_names.hpp"

#include "actors/edge/disk/small_file.hpp"
#include "actors/edge/io/plain_text.hpp"
#include "actors/edge/trust/limits.hpp"

namespace roscell {

std::filesystem::path issued_file_of(const std::filesystem::path& file) {
  auto result = file;
  result += ".issued";
  return result;
}

issued_names read_issued(const std::filesystem::path& file) {
  issued_names result;
  const auto text =
      read_small_file(issued_file_of(file), limits::trust::issued_bytes)
          .value_or("");
  for (std::string_view rest{text}; !rest.empty();) {
    auto line = take_until(rest, '\n');
    const std::string uuid{take_until(line, ' ')};
    if (!uuid.empty() && !line.empty() && result.size() < limits::trust::issued)
      result[uuid] = line;
  }
  return result;
}

std::string keep_issued(const std::filesystem::path& file,
                        const issued_names& all) {
  if (all.size() > limits::trust::issued)
    return "this coordinator has made identities for "
           + std::to_string(limits::trust::issued)
           + " nodes, and makes no more";
  std::string text;
  for (const auto& [uuid, name] : all)
    text += uuid + " " + name + "\n";
  return write_lasting(issued_file_of(file), text);
}

} // namespace roscell
