// Arbitrary bytes as a request: parsed, and checked as a message.
#include "test/fuzz/fuzz_support.hpp"

using namespace roscell;

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* bytes, size_t size) {
  const auto document = fuzz::parse(bytes, size);
  if (!document)
    return 0;
  auto again = parse_document(document->dump());
  if (!std::holds_alternative<json>(again)
      || std::get<json>(again) != *document)
    fuzz::found("a document changes on its way", *document);
  if (auto why = validate_message(*document))
    fuzz::check_refusal(*why);
  if (auto why = validate_document("plan_document", *document))
    fuzz::check_refusal(*why);
  return 0;
}
