#include "actors/core/ros2_setting.hpp"
#include "actors/core/routed_answer.hpp"
#include "actors/instances/container_supervisor_steps.hpp"
#include "actors/instances/life/skill_instance_steps.hpp"
#include "actors/instances/limits.hpp"
#include "messages/parameter_change.hpp"
#include "schemas/document.hpp"

namespace roscell {

namespace {

/// Whether the program hears it or not: one that does not gives up by itself.
void answer_request(container_supervisor_pointer self,
                    const std::string& instance, int64_t number,
                    const std::string& problem) {
  if (const auto& answer = self->state.config.answer_request)
    answer(instance, number, problem);
}

/// Why it is not asked for at all; empty: it is.
std::string why_not_asked(const container_supervisor_state& st,
                          const instance_row& row, const json* wanted) {
  if (!lets_ros2_set_parameters(row.spec))
    return "its cell lets no client of ROS 2 set parameters";
  if (wanted == nullptr || !wanted->is_object() || wanted->empty())
    return "no parameters are named";
  if (!st.router)
    return "its node is still starting; try again in a while";
  if (st.requesting.count(row.spec.instance) > 0)
    return "another change of its parameters is under way";
  return {};
}

} // namespace

/// In between the instance may end, and another program of its id may run:
/// numbers do not come again.
void ask_for_parameters(container_supervisor_pointer self,
                        const instance_row& row,
                        const instance_notified& asked) {
  auto& st = self->state;
  const auto instance = row.spec.instance;
  const auto number = asked.parameters_wanted;
  const auto read = parse_document(asked.wanted_parameters);
  const auto* wanted = std::get_if<json>(&read);
  if (const auto why = why_not_asked(st, row, wanted); !why.empty())
    return answer_request(self, instance, number, why);
  st.requesting.insert(instance);
  const auto end = [self, instance, number](const std::string& problem) {
    self->state.requesting.erase(instance);
    answer_request(self, instance, number, problem);
  };
  route_request request;
  request.text =
      message_json(parameter_change{instance, wanted->dump()}).dump();
  request.from = "a client of ROS 2, by instance '" + instance + "'";
  self->request(st.router, limits::instance::parameter_request,
                std::move(request))
      .then(
          [end](const request_routed& answer) {
            const auto why = refusal_in(answer);
            end(why ? sentence(to_error(*why)) : std::string{});
          },
          [end](const caf::error& why) { end(sentence(why)); });
}

} // namespace roscell
