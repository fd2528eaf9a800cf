#include "actors/instances/life/instance_text.hpp"
#include "actors/instances/life/skill_instance_steps.hpp"
#include "actors/instances/limits.hpp"
#include "messages/failure.hpp"

#include <caf/send.hpp>

namespace roscell {

namespace {

bool has_secrets(const instance_spec& spec) {
  return !spec.secrets.empty() || !spec.secret_env.empty();
}

lay_out_secrets layout_for(const skill_instance_state& st) {
  const auto& spec = st.row.spec;
  lay_out_secrets result;
  result.instance = spec.instance;
  result.files = spec.secrets;
  for (const auto& [variable, secret] : spec.secret_env)
    result.variables.push_back(secret);
  if (st.config.grants)
    result.user = st.config.grants->user_of(spec.operation);
  return result;
}

} // namespace

void with_secrets(skill_instance_pointer self,
                  const std::function<void(const secrets_laid_out&)>& next) {
  auto& st = self->state;
  if (!has_secrets(st.row.spec))
    return next({});
  if (!st.config.secrets)
    return conclude(self, instance_state::failed, "this node keeps no secrets");
  ask<secrets_laid_out>(self, st.config.secrets, limits::instance::secrets,
                        layout_for(st), next, [=](const caf::error& error) {
                          conclude(self, instance_state::failed,
                                   sentence(error));
                        });
}

void drop_secrets(skill_instance_pointer self) {
  const auto& st = self->state;
  if (has_secrets(st.row.spec) && st.config.secrets)
    caf::anon_send(st.config.secrets, clear_secrets{st.row.spec.instance});
}

instance_spec with_values(instance_spec spec, const secrets_laid_out& given) {
  size_t i = 0;
  for (const auto& [variable, secret] : spec.secret_env)
    if (i < given.values.size())
      spec.environment[variable] = given.values[i++];
  if (!given.folder.empty())
    spec.environment[secrets_variable] = given.folder;
  return spec;
}

} // namespace roscell
