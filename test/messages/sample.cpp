#include "test/messages/sample.hpp"

namespace roscell::test {

namespace {

/// What a field must look like whose text follows a rule of its own. Of the
/// letters 'N', 'H' and 'S' in it, N becomes the number, H 64 and S 16 digits.
constexpr std::pair<std::string_view, std::string_view> forms[] = {
    {"uuid", "00000000-0000-4000-8000-00000000000N"},
    {"cell_uuid", "00000000-0000-4000-8000-00000000000N"},
    {"address", "10.0.0.7:N"},
    {"on_boot", "stay"},
    {"log_excerpt.bytes", "bytesN"},
    {"exec_input.bytes", "bytesN"},
    {"exec_output.bytes", "bytesN"},
    {"discovery_server", "10.0.0.8:N"},
    {"node_description.coordinator", "10.0.0.9:N"},
    {"node_hello.coordinator", "10.0.0.9:N"},
    {"hash", "H"},
    {"skill", "H"},
    {"manifest", "H"},
    {"permit", "H"},
    {"build_key", "H"},
    {"sha256", "H"},
    {"pieces", "H"},
    {"image_id", "sha256:H"},
    {"layers", "sha256:H"},
    {"nonce", "H"},
    {"proof", "H"},
    {"session", "S"},
    {"session_hello.version", "1.N"},
    {"session_hello.role", "coordinator"},
    {"session_challenge.version", "1.N"},
    {"devices", "/dev/video_N"},
    {"capabilities", "KILL"},
    {"policy", "fifo"},
    {"grants", "echo=capability:KILL"},
    {"volumes", "/srv/models_N:/models:ro"},
    {"entry_point", "bin/program_N"},
    {"endpoint", "/scene_N/image"},
    {"topic", "/scene_N/image"},
    {"reliability", "best_effort"},
    {"durability", "transient_local"},
    {"setup", "/opt/ros_N/setup.bash"},
    {"remote", "10.0.0.9:N"},
    {"server_cell", "00000000-0000-4000-8000-00000000000N"},
    {"data_type", "image/x-N"},
    {"data_types", "image/x-N"},
    {"parameters", R"({"level":N})"},
    {"data", R"({"level":N})"},
    {"body", R"({"level":N,"type":"resource_query"})"},
    {"code", "conflict"},
    {"gone", "00000000-0000-4000-8000-00000000000N"},
    {"registration_challenge.state", "joining"},
    {"kind", "memory"},
    {"build", "H"},
    {"restart", R"({"delay_s":N})"},
    {"on_node_loss", R"({"after_s":3N})"},
    {"health", R"({"grace_s":N})"},
    {"task_history.events", R"({"level":N})"},
    {"end", "input:N"},
    {".state", R"({"level":N})"},
    {"task_set_row.request", R"({"level":N})"},
    {"former", R"({"level":N})"},
    {"secret_setting.value", "valueN"},
    {"trust", "identity"},
    {"digest", "H"},
    {"site_invitation.role", "viewer"},
    {".role", "viewer"},
    {"site_invitation.secret", "SS"},
    {".id", "SS"},
    {"invitation", "SS"},
    {"serial", "SS"},
    {"deposit", "SS"},
    {"site_entry.request", "SS"},
    {"identity_requested.request", "SS"},
    {"identity_requested.issuing", "SS"},
    {"site_entry.exported", "H"},
    {"addresses", "10.0.0.9:N"},
    {"site_status.site", "site-N"},
    {"site_invited.site", "site-N"},
    {"task_revision.request", R"({"level":N})"},
    {"window", "minute"},
    {"task_placement.plan",
     R"({"allocations":[],"optimal":true,"rejected":[],)"
     R"("score":{"alpha":0.1,"balance":0.5,"gap":0.0,"load":0.5,)"
     R"("lower_bound":0.5,"total":0.55},"task":"value_N","type":"task_plan"})"},
    {"task_placement.refusal",
     R"({"error":{"code":"conflict","hint":"","message":"value_N",)"
     R"("where":""},"type":"error"})"},
};

std::string_view form_of(std::string_view type, std::string_view field) {
  const auto full = std::string{type} + "." + std::string{field};
  std::string_view result = "value_N";
  for (const auto& [name, form] : forms) {
    if (name == full)
      return form;
    if (name == field)
      result = form;
  }
  return result;
}

} // namespace

std::string sample_text(std::string_view type, std::string_view field,
                        int number) {
  std::string result;
  const auto last = static_cast<char>('0' + number % 10);
  for (auto c : form_of(type, field)) {
    if (c == 'N')
      result += std::to_string(number);
    else if (c == 'H' || c == 'S')
      result += std::string(c == 'H' ? 63 : 15, 'a') + last;
    else
      result += c;
  }
  return result;
}

} // namespace roscell::test
