#include "actors/instances/secrets/secret_keeper.hpp"

#include "actors/core/clocks.hpp"
#include "actors/core/edge_failure.hpp"
#include "actors/edge/disk/limits.hpp"
#include "actors/edge/io/crypto.hpp"
#include "messages/event_kinds.hpp"
#include "messages/failure.hpp"
#include "schemas/utf8.hpp"

#include <caf/result.hpp>

#include <system_error>
#include <utility>

namespace roscell {

namespace {

using secret_keeper_pointer =
    secret_keeper_actor::stateful_pointer<secret_keeper_state>;

caf::error no_secret(secret_keeper_pointer self, const std::string& name,
                     const std::string& remedy) {
  return fail(error_code::conflict,
              "node '" + self->state.config.node + "' has no secret '" + name
                  + "'",
              "/name", remedy);
}

void publish_names(secret_keeper_pointer self) {
  if (const auto& names = self->state.config.names)
    names->set(self->state.table.names());
}

/// Texts about a value never show it.
caf::error fault_of_value(const std::optional<std::string>& value) {
  if (!value)
    return fail(error_code::schema_violation, "the value is no base64",
                "/value", "`roscell secret set` encodes it");
  if (value->empty())
    return fail(error_code::schema_violation, "the value is empty", "/value",
                "`roscell secret remove` removes a secret");
  if (value->size() > limits::secret::bytes)
    return fail(error_code::schema_violation,
                "the value has " + std::to_string(value->size())
                    + " bytes, and may have "
                    + std::to_string(limits::secret::bytes),
                "/value", "put a key that opens the rest there");
  return {};
}

caf::result<secret_set> set(secret_keeper_pointer self,
                            const secret_setting& request) {
  auto& st = self->state;
  const auto value = from_base64(request.value);
  if (auto why = fault_of_value(value))
    return why;
  secret_set result{request.name, st.table.has(request.name)};
  if (!result.replaced && st.table.is_full())
    return fail(error_code::conflict,
                "node '" + st.config.node + "' keeps "
                    + std::to_string(limits::secret::most) + " secrets already",
                "", "`roscell secret remove` removes one");
  if (const auto why = st.disk->write(request.name, *value))
    return to_caf(*why);
  st.table.keep(request.name, unix_now_ms());
  publish_names(self);
  st.config.context.publish_event(events::secret_set, request.name,
                                  {{"replaced", result.replaced}});
  return result;
}

caf::result<secret_removed> remove(secret_keeper_pointer self,
                                   const secret_removal& request) {
  auto& st = self->state;
  if (!st.table.has(request.name))
    return no_secret(self, request.name, "`roscell secret list` shows them");
  if (const auto why = st.disk->remove(request.name))
    return to_caf(*why);
  st.table.forget(request.name);
  publish_names(self);
  st.config.context.publish_event(events::secret_removed, request.name);
  return secret_removed{request.name, st.table.holders_of(request.name)};
}

/// The value of one that an instance is to have. Errors: as for all.
caf::error read_value(secret_keeper_pointer self, const std::string& name,
                      std::string& value) {
  auto& st = self->state;
  if (!st.table.has(name))
    return no_secret(self, name, "`roscell secret set " + name + "` there");
  auto read = st.disk->read(name);
  if (const auto* why = std::get_if<edge_error>(&read))
    return to_caf(*why);
  value = std::get<std::string>(std::move(read));
  return {};
}

/// A variable ends where a zero is, and engines take them as texts.
bool can_be_variable(const std::string& value) {
  return value.find('\0') == std::string::npos && valid_utf8(value) == value;
}

caf::error read_variables(secret_keeper_pointer self,
                          const std::vector<std::string>& names,
                          std::vector<std::string>& values) {
  for (const auto& name : names) {
    std::string value;
    if (auto why = read_value(self, name, value))
      return why;
    if (!can_be_variable(value))
      return fail(error_code::conflict,
                  "the secret '" + name
                      + "' is no text, and cannot be a "
                        "variable",
                  "", "name it in `secrets`, for a file");
    values.push_back(std::move(value));
  }
  return {};
}

caf::error make_files(secret_keeper_pointer self,
                      const lay_out_secrets& request, std::string& folder) {
  if (request.files.empty())
    return {};
  memory_folder::file_list files;
  for (const auto& name :
       std::set<std::string>{request.files.begin(), request.files.end()}) {
    std::string value;
    if (auto why = read_value(self, name, value))
      return why;
    files.emplace_back(name, std::move(value));
  }
  const auto made =
      self->state.memory->lay_out(request.instance, files, request.user);
  if (const auto* why = std::get_if<edge_error>(&made))
    return to_caf(*why);
  folder = std::get<std::filesystem::path>(made).string();
  return {};
}

caf::result<secrets_laid_out> lay_out(secret_keeper_pointer self,
                                      const lay_out_secrets& request) {
  auto& st = self->state;
  // Of an earlier run of the instance.
  st.memory->clear(request.instance);
  st.table.take_back(request.instance);
  secrets_laid_out result;
  if (auto why = read_variables(self, request.variables, result.values))
    return why;
  if (auto why = make_files(self, request, result.folder))
    return why;
  std::set<std::string> names{request.files.begin(), request.files.end()};
  names.insert(request.variables.begin(), request.variables.end());
  st.table.give(request.instance, std::move(names));
  return result;
}

void clear(secret_keeper_pointer self, const std::string& instance) {
  self->state.memory->clear(instance);
  self->state.table.take_back(instance);
}

/// What an earlier run of the node has left. What may still run keeps its own.
void take_up(secret_keeper_pointer self) {
  auto& st = self->state;
  std::set<std::string> living;
  for (auto& [instance, names] : st.config.given) {
    living.insert(instance);
    st.table.give(instance, names);
  }
  st.memory->clear_others(living);
  const auto found = st.disk->look();
  for (const auto& x : found.secrets)
    st.table.keep(x.name, x.set_unix_ms);
  for (const auto& x : found.ignored)
    st.config.context.publish_event(
        events::secret_ignored, "-",
        {{"path", valid_utf8(x.path)}, {"reason", valid_utf8(x.reason)}});
  publish_names(self);
}

} // namespace

secret_keeper_actor::behavior_type
secret_keeper(secret_keeper_pointer self, const secret_keeper_config& config) {
  auto& st = self->state;
  st.config = config;
  st.disk.emplace(config.folder);
  st.memory.emplace(config.places, config.place_name);
  take_up(self);
  return {
      [self](const state_query&) {
        const auto& table = self->state.table;
        return state_of({{"secrets", table.names()},
                         {"instances_with_secrets", table.given()}});
      },
      [self](const secret_setting& x) { return set(self, x); },
      [self](const secret_query&) { return self->state.table.list(); },
      [self](const secret_removal& x) { return remove(self, x); },
      [self](const lay_out_secrets& x) { return lay_out(self, x); },
      [self](const clear_secrets& x) { clear(self, x.instance); },
  };
}

std::string place_name_of(const std::filesystem::path& data_dir) {
  constexpr std::string_view key = "roscell secrets";
  constexpr size_t digits = 32;
  std::error_code ignored;
  const auto real = std::filesystem::weakly_canonical(data_dir, ignored);
  const auto hash =
      to_hex(hmac_sha256(key, (ignored ? data_dir : real).native()));
  return "roscell-secrets-" + hash.substr(0, digits);
}

std::set<std::string> secrets_of(const instance_spec& spec) {
  std::set<std::string> result{spec.secrets.begin(), spec.secrets.end()};
  for (const auto& [variable, secret] : spec.secret_env)
    result.insert(secret);
  return result;
}

} // namespace roscell
