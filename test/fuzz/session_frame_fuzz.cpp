// Arbitrary bytes as a frame of a session: the envelope, and the message in it
// as the struct that its receiver gets.
#include "actors/edge/session/session_frames.hpp"
#include "messages/allocation_report.hpp"
#include "messages/cell.hpp"
#include "messages/event.hpp"
#include "messages/kept_log.hpp"
#include "messages/reservation.hpp"
#include "messages/session.hpp"
#include "messages/task.hpp"
#include "test/fuzz/fuzz_support.hpp"

using namespace roscell;

namespace {

template <class T>
void check_if(const json& message) {
  if (message["type"] == T::type)
    fuzz::check_decoding<T>(message);
}

template <class... Ts>
void check_any(const json& message) {
  (check_if<Ts>(message), ...);
}

void check_message(const json& message) {
  if (auto why = validate_message(message))
    return fuzz::check_refusal(*why);
  if (message["type"] == "error")
    fuzz::check_refusal(failure_from(message));
  check_any<cell_query, cell_list_query, task_request, task_plan_query,
            task_query, task_termination, instance_query, log_query,
            kept_logs_query, kept_logs, node_query, skill_query,
            cell_description, cell_list, task_accepted, task_plan,
            task_description, task_terminated, instance_description,
            log_excerpt, node_description, skill_list, event>(message);
  check_any<session_request, session_reply, session_notice, node_registration,
            node_registered, node_departure, node_departed, resource_query,
            resource_report, figures_query, figures_report, instance_deployment,
            instance_deployed, instance_removal, instances_removed,
            instance_changed, skills_changed, instance_reservation,
            instances_reserved, session_hello, session_challenge, session_proof,
            session_accepted>(message);
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* bytes, size_t size) {
  const auto frame = fuzz::parse(bytes, size);
  if (!frame)
    return 0;
  check_message(*frame);
  if (frame->is_object() && frame->contains("body"))
    check_message((*frame)["body"]);
  return 0;
}
