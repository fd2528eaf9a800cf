#include "messages/handshake.hpp"
#include "messages/image.hpp"
#include "messages/parameter_change.hpp"
#include "messages/reservation.hpp"
#include "messages/session.hpp"
#include "schemas/rules/field_schema.hpp"
#include "schemas/schema_list.hpp"

#include <algorithm>

namespace roscell {

// What users see of a cell, too, is described where they find it.
template <>
constexpr const char* shared_definition<build_name> = "build_name";
template <>
constexpr const char* shared_definition<build_offer> = "build_offer";
template <>
constexpr const char* shared_definition<installed_skill> = "installed_skill";
template <>
constexpr const char* shared_definition<instance_metrics> = "instance_figures";
template <>
constexpr const char* shared_definition<instance_row> = "instance_row";
template <>
constexpr const char* shared_definition<instance_spec> = "instance_spec";
template <>
constexpr const char* shared_definition<node_resources> = "node_resources";
template <>
constexpr const char* shared_definition<skill_problem> = "skill_problem";

namespace {

template <class Message>
schema_entry made(std::string_view reply = {},
                  std::string_view kind = "session") {
  return {Message::type, kind, reply, {}, field_schemas::of_fields<Message>};
}

template <class Request, class Reply>
void add_exchange(std::vector<schema_entry>& result,
                  std::string_view kind = "session",
                  std::string_view reply_kind = "session") {
  result.push_back(made<Request>(Reply::type, kind));
  result.push_back(made<Reply>({}, reply_kind));
}

} // namespace

json schema_entry::document() const {
  if (make == nullptr)
    return json::parse(text);
  auto result = make();
  field_schemas::add_member(result, "type", {{"const", name}}, true);
  if (kind == "request")
    field_schemas::add_member(result, "request_id",
                              field_schemas::definition("request_id"), false);
  return result;
}

std::vector<schema_entry> node_schemas() {
  std::vector<schema_entry> result{
      made<session_hello>(session_challenge::type, "handshake"),
      made<session_challenge>(session_proof::type, "handshake"),
      made<session_proof>(session_accepted::type, "handshake"),
      made<session_accepted>({}, "handshake"),
      made<session_notice>(),
      made<instance_changed>(),
      made<skills_changed>(),
      made<cell_standing>(),
      made<cell_changed>(),
  };
  add_exchange<session_request, session_reply>(result);
  add_exchange<node_registration, node_registered>(result);
  add_exchange<node_departure, node_departed>(result);
  add_exchange<resource_query, resource_report>(result);
  add_exchange<figures_query, figures_report>(result);
  add_exchange<instance_reservation, instances_reserved>(result);
  add_exchange<instance_deployment, instance_deployed>(result);
  add_exchange<instance_removal, instances_removed>(result);
  add_exchange<set_parameters, parameters_set>(result);
  add_exchange<build_keeping, build_kept>(result);
  add_exchange<build_release, build_released>(result);
  add_exchange<image_request, image_offered>(result);
  add_exchange<image_query, image_known>(result);
  add_exchange<image_sharing, image_shared>(result);
  add_exchange<place_request, place_granted>(result);
  add_exchange<place_reservation, place_reserved>(result);
  add_exchange<member_surrender, members_surrendered>(result);
  // At a node's HTTP port, with a proof that the site token is known.
  add_exchange<registration_query, registration_challenge>(result, "request",
                                                           "reply");
  add_exchange<registration_switch, switch_accepted>(result, "request",
                                                     "reply");
  return result;
}

std::vector<schema_entry> all_schemas() {
  auto result = node_schemas();
  const auto files = file_schemas();
  result.insert(result.end(), files.begin(), files.end());
  std::sort(result.begin(), result.end(),
            [](const auto& x, const auto& y) { return x.name < y.name; });
  return result;
}

} // namespace roscell
