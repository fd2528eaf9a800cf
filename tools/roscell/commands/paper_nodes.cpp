#include "tools/roscell/commands/paper_nodes.hpp"

namespace roscell::cli {

namespace {

void add_missing(json& object, const char* name, json value) {
  if (!object.contains(name))
    object[name] = std::move(value);
}

/// Nothing is used of an amount that does not say so.
void complete_amount(json& owner, const char* name) {
  const auto amount = owner.find(name);
  if (amount != owner.end() && amount->is_object())
    add_missing(*amount, "used", 0);
}

} // namespace

void complete_paper_node(json& node) {
  if (!node.is_object())
    return;
  add_missing(node, "unified_memory", false);
  add_missing(node, "gpus", json::array());
  add_missing(node, "labels", json::object());
  add_missing(node, "devices", json::array());
  for (const auto* name : {"cpu", "memory_mib", "disk_mib"})
    complete_amount(node, name);
  auto& gpus = node["gpus"];
  if (gpus.is_array())
    for (auto& gpu : gpus)
      if (gpu.is_object())
        complete_amount(gpu, "memory_mib");
}

} // namespace roscell::cli
