#include "actors/cell/tables/task_table.hpp"

#include <algorithm>
#include <string>
#include <utility>

/// Parameters of a task's steps that are changed while they run.
namespace roscell {

namespace {

json object_in(const std::string& text) {
  auto result = json::parse(text, nullptr, false);
  return result.is_object() ? result : json::object();
}

std::string text_of(const json& value) {
  return value.dump(-1, ' ', false, json::error_handler_t::replace);
}

/// Null if the request has none of that id.
json* find_step(json& request, const std::string& step) {
  const auto pipeline = request.find("pipeline");
  if (pipeline == request.end() || !pipeline->is_array())
    return nullptr;
  const auto found =
      std::find_if(pipeline->begin(), pipeline->end(), [&](const json& x) {
        return x.is_object() && x.value("id", json{}) == step;
      });
  return found == pipeline->end() ? nullptr : &*found;
}

} // namespace

bool requests_step(const std::string& request, const std::string& step) {
  auto document = object_in(request);
  return find_step(document, step) != nullptr;
}

task_record with_parameters(task_record record, const std::string& step,
                            const json& values) {
  auto request = object_in(record.request);
  if (auto* found = find_step(request, step)) {
    auto& parameters = (*found)["parameters"];
    if (!parameters.is_object())
      parameters = json::object();
    parameters.update(values);
    record.request = text_of(request);
  }
  for (auto& spec : record.specs)
    if (spec.step == step) {
      auto parameters = object_in(spec.parameters);
      parameters.update(values);
      spec.parameters = text_of(parameters);
    }
  return record;
}

} // namespace roscell
