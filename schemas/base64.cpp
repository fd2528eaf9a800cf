#include "schemas/base64.hpp"

#include <boost/archive/iterators/base64_from_binary.hpp>
#include <boost/archive/iterators/binary_from_base64.hpp>
#include <boost/archive/iterators/transform_width.hpp>

#include <algorithm>
#include <cstddef>

namespace roscell {

namespace {

namespace steps = boost::archive::iterators;

constexpr size_t group_bytes = 3;
constexpr size_t group_characters = 4;

} // namespace

std::string to_base64(std::string_view bytes) {
  using digits = steps::base64_from_binary<
      steps::transform_width<std::string::const_iterator, 6, 8>>;
  const auto missing = (group_bytes - bytes.size() % group_bytes) % group_bytes;
  std::string whole{bytes};
  whole.append(missing, '\0');
  std::string result{digits{whole.cbegin()}, digits{whole.cend()}};
  std::fill(result.end() - static_cast<std::ptrdiff_t>(missing), result.end(),
            '=');
  return result;
}

std::optional<std::string> from_base64(std::string_view text) {
  using bytes = steps::transform_width<
      steps::binary_from_base64<std::string::const_iterator>, 8, 6>;
  const auto end = text.find_last_not_of('=') + 1;
  const auto missing = text.size() - end;
  // Boost takes a '=' in the middle.
  if (text.size() % group_characters != 0 || missing >= group_bytes
      || text.substr(0, end).find('=') != std::string_view::npos)
    return std::nullopt;
  std::string whole{text};
  std::replace(whole.begin() + static_cast<std::ptrdiff_t>(end), whole.end(),
               '=', 'A');
  try {
    std::string result{bytes{whole.cbegin()}, bytes{whole.cend()}};
    result.resize(result.size() - missing);
    return result;
  } catch (const steps::dataflow_exception&) {
    return std::nullopt;
  }
}

} // namespace roscell
