#include "skills/engine/parameters.hpp"

#include "skills/engine/errors.hpp"

#include <sstream>

namespace roscell::engine {

namespace {

template <class... Ts>
[[noreturn]] void reject(const std::string& name, const nlohmann::json& value,
                         const Ts&... expected) {
  std::ostringstream text;
  text << "parameter '" << name << "' must be ";
  (text << ... << expected);
  auto shown =
      value.dump(-1, ' ', true, nlohmann::json::error_handler_t::replace);
  text << ", but is " << shown.substr(0, 100)
       << "; correct it in the step's parameters or in skill.json";
  throw start_error(text.str());
}

} // namespace

parameters::parameters() : values_(nlohmann::json::object()) {
  // nop
}

parameters::parameters(nlohmann::json values) : values_(std::move(values)) {
  if (!values_.is_object())
    throw start_error("ROSCELL_PARAMETERS must be a JSON object");
}

bool parameters::flag(const std::string& name, bool fallback) const {
  auto i = values_.find(name);
  if (i == values_.end())
    return fallback;
  if (!i->is_boolean())
    reject(name, *i, "true or false");
  return i->get<bool>();
}

std::uint64_t parameters::count(const std::string& name, std::uint64_t fallback,
                                std::uint64_t least, std::uint64_t most) const {
  auto i = values_.find(name);
  if (i == values_.end())
    return fallback;
  // A number that was not parsed but made in code may be a signed one.
  auto whole = i->is_number_unsigned()
               || (i->is_number_integer() && i->get<std::int64_t>() >= 0);
  if (!whole || i->get<std::uint64_t>() < least
      || i->get<std::uint64_t>() > most)
    reject(name, *i, "a whole number from ", least, " to ", most);
  return i->get<std::uint64_t>();
}

double parameters::number(const std::string& name, double fallback,
                          double least, double most) const {
  auto i = values_.find(name);
  if (i == values_.end())
    return fallback;
  if (!i->is_number() || !(i->get<double>() >= least)
      || !(i->get<double>() <= most))
    reject(name, *i, "a number from ", least, " to ", most);
  return i->get<double>();
}

std::string parameters::text(const std::string& name,
                             const std::string& fallback) const {
  auto i = values_.find(name);
  if (i == values_.end())
    return fallback;
  if (!i->is_string())
    reject(name, *i, "a text");
  return i->get<std::string>();
}

} // namespace roscell::engine
