#include "test/schemas/oracle.hpp"

#include "schemas/schema_list.hpp"

#include <valijson/adapters/nlohmann_json_adapter.hpp>
#include <valijson/schema.hpp>
#include <valijson/schema_parser.hpp>
#include <valijson/validator.hpp>

#include <map>
#include <memory>
#include <stdexcept>

namespace roscell::test {

namespace {

using adapter = valijson::adapters::NlohmannJsonAdapter;

json document_named(std::string_view name) {
  for (const auto& schema : all_schemas()) {
    if (schema.name != name)
      continue;
    auto result = schema.document();
    // Without it, valijson takes references as they stand.
    result.erase("$id");
    return result;
  }
  throw std::logic_error{"no such schema: " + std::string{name}};
}

std::unique_ptr<valijson::Schema> parse(const std::string& name) {
  auto fetch = [](const std::string& uri) -> const json* {
    auto file = uri.substr(uri.rfind('/') + 1);
    return new json(document_named(file.substr(0, file.find('.'))));
  };
  auto free = [](const json* document) { delete document; };
  auto result = std::make_unique<valijson::Schema>();
  const auto document = document_named(name);
  valijson::SchemaParser{valijson::SchemaParser::kDraft7}
      .populateSchema<adapter>(adapter{document}, *result, fetch, free);
  return result;
}

} // namespace

bool oracle_accepts(const std::string& schema, const json& document) {
  static std::map<std::string, std::unique_ptr<valijson::Schema>> schemas;
  auto& parsed = schemas[schema];
  if (!parsed)
    parsed = parse(schema);
  static valijson::Validator validator;
  return validator.validate(*parsed, adapter{document}, nullptr);
}

bool oracle_accepts(const json& schema, const json& document) {
  valijson::Schema parsed;
  valijson::SchemaParser{valijson::SchemaParser::kDraft7}.populateSchema(
      adapter{schema}, parsed);
  return valijson::Validator{}.validate(parsed, adapter{document}, nullptr);
}

} // namespace roscell::test
