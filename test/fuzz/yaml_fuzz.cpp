// Arbitrary bytes as YAML: what is taken is a document that JSON can carry, and
// that means the same when its JSON is read as YAML.
#include "schemas/document.hpp"
#include "test/fuzz/fuzz_support.hpp"

using namespace roscell;

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* bytes, size_t size) {
  const std::string_view text{reinterpret_cast<const char*>(bytes), size};
  const auto parsed = parse_document(text, document_format::yaml);
  if (const auto* why = std::get_if<failure>(&parsed)) {
    fuzz::check_refusal(*why);
    if (!find_problem(text, document_format::yaml))
      fuzz::found("a refusal has no place", why->message);
    return 0;
  }
  const auto& document = std::get<json>(parsed);
  const auto written = document.dump();
  for (const auto format : {document_format::json, document_format::yaml}) {
    const auto again = parse_document(written, format);
    if (!std::holds_alternative<json>(again)
        || std::get<json>(again) != document)
      fuzz::found("a document changes on its way", document);
  }
  const auto flat = document.flatten();
  if (flat.is_object() && !flat.empty()
      && !find_place(text, document_format::yaml, flat.items().begin().key()))
    fuzz::found("a value has no place", document);
  return 0;
}
