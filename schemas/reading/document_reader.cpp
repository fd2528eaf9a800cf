#include "schemas/reading/document_reader.hpp"

#include "schemas/reading/json_reader.hpp"
#include "schemas/reading/yaml_reader.hpp"

namespace roscell {

bool read_document(std::string_view text, document_format format,
                   document_events& events) {
  return format == document_format::yaml ? read_yaml(text, events)
                                         : read_json(text, events);
}

} // namespace roscell
