#include "tools/roscell/ros2/echo/message_value.hpp"

#include <fastcdr/Cdr.h>
#include <fastcdr/FastBuffer.h>
#include <fastcdr/exceptions/Exception.h>

#include <cmath>
#include <cstdint>
#include <map>

namespace roscell::cli {

namespace {

using eprosima::fastcdr::Cdr;
using value = message_json_value;

/// Definitions that name each other would go on for ever.
constexpr int most_depth = 32;

/// What stands for items that were left out.
constexpr const char* left_out = "... ";

/// Reads one message. What it says of lengths is checked against what is left.
class reader {
public:
  reader(message_library& library, const std::string& payload,
         std::size_t most_items)
      : library_{library}, size_{payload.size()}, most_items_{most_items},
        buffer_{const_cast<char*>(payload.data()), payload.size()},
        cdr_{buffer_, Cdr::DEFAULT_ENDIAN, Cdr::DDS_CDR} {
    cdr_.read_encapsulation();
  }

  value message(const std::string& type, int depth) {
    if (depth > most_depth)
      throw definition_error{type + ": definitions name each other"};
    auto result = value::object();
    for (const auto& field : library_.find(type))
      result[field.name] =
          field.is_array ? items(field, depth) : item(field.type, depth);
    return result;
  }

private:
  value items(const message_field& field, int depth) {
    auto count = field.items;
    if (count == 0) {
      std::uint32_t said = 0;
      cdr_ >> said;
      count = said;
    }
    if (count > size_ - cdr_.getSerializedDataLength())
      throw definition_error{field.name + " says that it has "
                             + std::to_string(count)
                             + " items, more than there are bytes"};
    auto result = value::array();
    for (std::size_t i = 0; i < count; ++i) {
      auto one = item(field.type, depth);
      if (i < most_items_)
        result.push_back(std::move(one));
    }
    if (count > most_items_)
      result.push_back(left_out + std::to_string(count) + " in all");
    return result;
  }

  template <class T>
  value number() {
    T x{};
    cdr_ >> x;
    return x;
  }

  value text() {
    std::string x;
    cdr_ >> x;
    return x;
  }

  value item(const std::string& type, int depth) {
    using kind = value (reader::*)();
    static const std::map<std::string, kind> kinds{
        {"bool", &reader::number<bool>},
        {"byte", &reader::number<std::uint8_t>},
        {"char", &reader::number<std::uint8_t>},
        {"uint8", &reader::number<std::uint8_t>},
        {"int8", &reader::number<std::int8_t>},
        {"int16", &reader::number<std::int16_t>},
        {"uint16", &reader::number<std::uint16_t>},
        {"int32", &reader::number<std::int32_t>},
        {"uint32", &reader::number<std::uint32_t>},
        {"int64", &reader::number<std::int64_t>},
        {"uint64", &reader::number<std::uint64_t>},
        {"float32", &reader::number<float>},
        {"float64", &reader::number<double>},
        {"string", &reader::text}};
    if (const auto i = kinds.find(type); i != kinds.end())
      return (this->*i->second)();
    if (type == "wstring")
      throw definition_error{"texts of type wstring cannot be shown"};
    return message(type, depth + 1);
  }

  message_library& library_;
  const std::size_t size_;
  const std::size_t most_items_;
  eprosima::fastcdr::FastBuffer buffer_;
  Cdr cdr_;
};

bool is_plain(const value& x) {
  return !x.is_structured();
}

std::string scalar_text(const value& x) {
  if (x.is_number_float() && !std::isfinite(x.get<double>()))
    return std::isnan(x.get<double>()) ? ".nan"
           : x.get<double>() > 0       ? ".inf"
                                       : "-.inf";
  return x.dump(-1, ' ', false, value::error_handler_t::replace);
}

bool is_left_out(const value& x) {
  return x.is_string()
         && x.get_ref<const std::string&>().rfind(left_out, 0) == 0;
}

std::string flow_text(const value& list) {
  std::string result;
  for (const auto& x : list)
    result += (result.empty() ? "" : ", ")
              + (is_left_out(x) ? x.get<std::string>() : scalar_text(x));
  return "[" + result + "]";
}

void put(std::string& to, const value& x, const std::string& indent);

void put_member(std::string& to, const std::string& name, const value& x,
                const std::string& indent) {
  to += indent + name + ":";
  const bool is_flow = x.is_array() && (x.empty() || is_plain(x.front()));
  if (is_plain(x) || is_flow) {
    to += " " + (is_flow ? flow_text(x) : scalar_text(x)) + "\n";
    return;
  }
  to += "\n";
  put(to, x, indent + (x.is_array() ? "" : "  "));
}

void put(std::string& to, const value& x, const std::string& indent) {
  if (x.is_object()) {
    for (const auto& [name, member] : x.items())
      put_member(to, name, member, indent);
    return;
  }
  for (const auto& one : x) {
    if (is_plain(one)) {
      to += indent + "# " + one.get<std::string>() + "\n";
      continue;
    }
    std::string lines;
    put(lines, one, indent + "  ");
    lines.replace(indent.size(), 1, "-");
    to += lines;
  }
}

} // namespace

message_json_value message_value(message_library& library,
                                 const std::string& type,
                                 const std::string& payload,
                                 std::size_t most_items) {
  try {
    reader in{library, payload, most_items};
    return in.message(type, 0);
  } catch (const eprosima::fastcdr::exception::Exception& why) {
    throw definition_error{"a message is no " + type
                           + " as it is defined here: " + why.what()};
  }
}

std::string value_text(const message_json_value& value) {
  std::string result;
  put(result, value, "");
  return result;
}

} // namespace roscell::cli
