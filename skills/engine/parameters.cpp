#include "roscell/skill/parameters.hpp"
#include "roscell/skill/errors.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <sstream>

namespace roscell::engine {

struct parameters::content {
  nlohmann::json values = nlohmann::json::object();

  /// The parameter, or nullptr.
  const nlohmann::json* find(const std::string& name) const {
    auto i = values.find(name);
    return i != values.end() ? &*i : nullptr;
  }
};

namespace {

std::string shown(const nlohmann::json& value) {
  return value.dump(-1, ' ', true, nlohmann::json::error_handler_t::replace);
}

template <class... Ts>
[[noreturn]] void reject(const std::string& name, const nlohmann::json& value,
                         const Ts&... expected) {
  std::ostringstream text;
  text << "parameter '" << name << "' must be ";
  (text << ... << expected);
  text << ", but is " << shown(value).substr(0, 100)
       << "; correct it in the step's parameters or in skill.json";
  throw start_error(text.str());
}

bool is_list(const nlohmann::json& value, std::size_t most_items,
             bool (nlohmann::json::*is_item)() const noexcept) {
  return value.is_array() && value.size() <= most_items
         && std::all_of(value.begin(), value.end(),
                        [&](const auto& item) { return (item.*is_item)(); });
}

} // namespace

parameters::parameters() : content_(std::make_shared<content>()) {
  // nop
}

parameters::parameters(std::shared_ptr<const content> values)
    : content_(std::move(values)) {
  // nop
}

parameters parameters::parse(std::string_view text) {
  auto result = std::make_shared<content>();
  try {
    result->values = nlohmann::json::parse(text);
  } catch (const nlohmann::json::parse_error& e) {
    throw start_error("ROSCELL_PARAMETERS is not JSON, see its byte "
                      + std::to_string(e.byte));
  }
  if (!result->values.is_object())
    throw start_error("ROSCELL_PARAMETERS must be a JSON object");
  return parameters{std::move(result)};
}

bool parameters::has(const std::string& name) const {
  return content_->find(name) != nullptr;
}

bool parameters::flag(const std::string& name, bool fallback) const {
  const auto* value = content_->find(name);
  if (value == nullptr)
    return fallback;
  if (!value->is_boolean())
    reject(name, *value, "true or false");
  return value->get<bool>();
}

std::uint64_t parameters::count(const std::string& name, std::uint64_t fallback,
                                std::uint64_t least, std::uint64_t most) const {
  const auto* value = content_->find(name);
  if (value == nullptr)
    return fallback;
  if (!value->is_number_unsigned() || value->get<std::uint64_t>() < least
      || value->get<std::uint64_t>() > most)
    reject(name, *value, "a whole number from ", least, " to ", most);
  return value->get<std::uint64_t>();
}

double parameters::number(const std::string& name, double fallback,
                          double least, double most) const {
  const auto* value = content_->find(name);
  if (value == nullptr)
    return fallback;
  if (!value->is_number() || !(value->get<double>() >= least)
      || !(value->get<double>() <= most))
    reject(name, *value, "a number from ", least, " to ", most);
  return value->get<double>();
}

std::string parameters::text(const std::string& name,
                             const std::string& fallback) const {
  const auto* value = content_->find(name);
  if (value == nullptr)
    return fallback;
  if (!value->is_string())
    reject(name, *value, "a text");
  return value->get<std::string>();
}

std::vector<double> parameters::numbers(const std::string& name,
                                        const std::vector<double>& fallback,
                                        std::size_t most_items) const {
  const auto* value = content_->find(name);
  if (value == nullptr)
    return fallback;
  if (!is_list(*value, most_items, &nlohmann::json::is_number))
    reject(name, *value, "a list of at most ", most_items, " numbers");
  return value->get<std::vector<double>>();
}

std::vector<std::string>
parameters::texts(const std::string& name,
                  const std::vector<std::string>& fallback,
                  std::size_t most_items) const {
  const auto* value = content_->find(name);
  if (value == nullptr)
    return fallback;
  if (!is_list(*value, most_items, &nlohmann::json::is_string))
    reject(name, *value, "a list of at most ", most_items, " texts");
  return value->get<std::vector<std::string>>();
}

std::string parameters::json(const std::string& name) const {
  const auto* value = content_->find(name);
  return value != nullptr ? shown(*value) : "";
}

std::string parameters::all() const {
  return shown(content_->values);
}

std::string current_error() {
  try {
    throw;
  } catch (const std::exception& e) {
    return e.what();
  } catch (...) {
    return "an exception that is no std::exception";
  }
}

} // namespace roscell::engine
