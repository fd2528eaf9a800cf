#include "tools/roscell/view/views.hpp"

#include "test/printed_text.hpp"
#include "test/words.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <sstream>

using namespace roscell;
using namespace roscell::cli;
using roscell::test::cells_in;
using roscell::test::right_aligned;

namespace {

view_style at(int64_t now_unix_ms) {
  return {{}, now_unix_ms};
}

instance_row sample_instance() {
  instance_row row;
  row.spec.instance = "t-poses-1a2b3c4d";
  row.spec.task = "t";
  row.spec.step = "poses";
  row.spec.model = "apriltag3";
  row.spec.deployment = "cpu";
  row.node = "arm-1";
  row.state = instance_state::running;
  row.since_unix_ms = 1000;
  return row;
}

node_resources sample_resources() {
  node_resources r;
  r.name = "arm-1";
  r.architecture = "arm64";
  r.cpu = {4, 0.5};
  r.memory_mib = {3911, 812.4};
  r.disk_mib = {20000, 5000};
  return r;
}

using roscell::test::has;

} // namespace

TEST_CASE("an empty list says so in words", "[tools]") {
  CHECK(cells_view({}, at(0)) == "no cells\n");
  CHECK(members_view({}, at(0)) == "no nodes\n");
  CHECK(tasks_view({}, at(0)) == "no tasks\n");
  CHECK(instances_view({}, at(0)) == "no instances\n");
  CHECK(skills_view({}, at(0)) == "no skills\n");
}

TEST_CASE("a cell's row shows its size and where to join it", "[tools]") {
  const cell_list cells{{{"lab",
                          "arm-1",
                          "10.0.0.1:8420",
                          "10.0.0.1:11811",
                          3,
                          "",
                          {{"ROS_DISCOVERY_SERVER", ";10.0.0.1:11811"},
                           {"ROS_DOMAIN_ID", "7"}}}}};
  const auto text = cells_view(cells, at(0));
  CHECK(cells_in(text)
        == "CELL|COORDINATOR|NODES|ADDRESS|DISCOVERY SERVER|"
           "ROS_DISCOVERY_SERVER|ROS_DOMAIN_ID\n"
           "lab|arm-1|3|10.0.0.1:8420|10.0.0.1:11811|;10.0.0.1:11811|7\n");
  CHECK(right_aligned(text) == "NODES|ROS_DOMAIN_ID");
}

TEST_CASE("problems have a column only if a cell has some", "[tools]") {
  const cell_list cells{
      {{"lab", "arm-1", "10.0.0.1:8420", "10.0.0.1:11811", 3, ""},
       {"hall", "arm-2", "10.0.0.2:8420", "10.0.0.2:11811", 0, "no route"}}};
  CHECK(has(cells_in(cells_view(cells, at(0))),
            "|ROS_DOMAIN_ID|TROUBLE\n"
            "lab|arm-1|3|10.0.0.1:8420|10.0.0.1:11811|-|-|-\n"
            "hall|arm-2|-|10.0.0.2:8420|10.0.0.2:11811|-|-|no route\n"));
}

TEST_CASE("both claims of a cell's name are shown as a problem", "[tools]") {
  const cell_list cells{{{"lab", "arm-1", "10.0.0.1:8420", "", 3, ""},
                         {"hall", "arm-3", "10.0.0.3:8420", "", 1, ""},
                         {"lab", "arm-2", "10.0.0.2:8420", "", 1, "told"}}};
  const auto text = cells_in(cells_view(cells, at(0)));
  CHECK(has(text, "2 coordinators claim this name\n"));
  CHECK(has(text, "told\n"));
  CHECK(has(text, "10.0.0.3:8420|-|-|-|-\n"));
}

TEST_CASE("a task that is named is shown with its steps, and how long data "
          "are under way",
          "[tools]") {
  task_row task;
  task.task = "fleet";
  task.submitted_unix_ms = 1;
  for (const double age_ms : {3.0, 41.26}) {
    instance_row row;
    row.spec.step = age_ms < 4 ? "camera" : "poses";
    row.node = "arm";
    row.state = instance_state::running;
    row.metrics.age_ms = age_ms;
    task.instances.push_back(row);
  }
  const auto text = task_view({{task}}, at(0));
  CHECK(has(text, "camera  arm   running"));
  CHECK(has(text, "41.3 ms\n"));
  CHECK(has(text, "from a sensor's stamp to the last output: 41.3 ms"));
  task.instances.clear();
  CHECK_FALSE(has(task_view({{task}}, at(0)), "DATA AGE"));
}

TEST_CASE("a step that does not simply run says why", "[tools]") {
  task_row task;
  task.instances.resize(2);
  for (auto& row : task.instances)
    row.state = instance_state::running;
  CHECK_FALSE(has(task_view({{task}}, at(0)), "REMARK"));
  task.instances[1].state = instance_state::failed;
  task.instances[1].reason = "it is preempted by task 'high'";
  CHECK(has(task_view({{task}}, at(0)), "it is preempted by task 'high'\n"));
}

TEST_CASE("a node that has a coordinator is a member", "[tools]") {
  cell_description cell;
  cell.nodes.resize(2);
  cell.nodes[0].role = node_role::coordinator;
  cell.nodes[0].identity.name = "head";
  cell.nodes[1].identity.name = "arm";
  const auto text = members_view(cell, at(0));
  CHECK(has(text, "\nhead  coordinator  "));
  CHECK(has(text, "\narm   member       "));
}

TEST_CASE("nodes in no cell are listed below the members", "[tools]") {
  cell_description cell;
  cell.nodes.resize(1);
  cell.nodes[0].identity.name = "head";
  cell.free = {{"arm-1", "u", "10.0.0.2:8420", node_state::independent, ""},
               {"arm-2", "v", "10.0.0.3:8420", node_state::orphaned, "hall"}};
  const auto text = members_view(cell, at(0));
  CHECK(text.find("\nhead ") < text.find("\narm-1 "));
  CHECK(has(text, "\narm-1  -       independent      -  10.0.0.2:8420"));
  CHECK(has(text, "\narm-2  -       orphaned         -  10.0.0.3:8420"));
  CHECK(has(text, "  it was in cell 'hall'\n"));
}

TEST_CASE("a node's row shows use and capacity with units", "[tools]") {
  registry_row row;
  row.identity = {"arm-1", "u", 1, "10.0.0.1:8420"};
  row.state = row_state::lost;
  row.since_unix_ms = 1000;
  row.reason = "no heartbeat for 8 s";
  row.resources = sample_resources();
  cell_description cell;
  cell.nodes = {row};
  const auto text = members_view(cell, at(61000));
  CHECK(has(text, " 0.5/4 "));
  CHECK(has(text, " 0.8/3.8 GiB "));
  CHECK(has(text, " 4.9/19.5 GiB "));
  CHECK(has(text, "lost   1m00s"));
  CHECK(has(text, "no heartbeat for 8 s"));
}

TEST_CASE("what a node has not measured yet is not shown as zero", "[tools]") {
  cell_description cell;
  cell.nodes.resize(1);
  CHECK_FALSE(has(members_view(cell, at(0)), "0/0"));
}

TEST_CASE("a task's row counts the steps that run", "[tools]") {
  auto failed = sample_instance();
  failed.state = instance_state::failed;
  failed.node = "arm-2";
  const task_description tasks{
      {{"t", task_state::degraded, 1000, 0, {sample_instance(), failed}}}};
  const auto text = tasks_view(tasks, at(6000));
  CHECK(cells_in(text)
        == "TASK|STATE|AGE|RUNNING|NODES\nt|degraded|5s|1/2|arm-1,arm-2\n");
  CHECK(right_aligned(text) == "AGE|RUNNING");
}

TEST_CASE("what waits is shown with whom and for how long", "[tools]") {
  auto lost = sample_instance();
  lost.unknown_since_unix_ms = 1000;
  lost.waits = "moves unless node 'arm-1' is back within 60 s";
  const auto name = lost.spec.task + "/" + lost.spec.step;
  task_description tasks{{{"t", task_state::degraded, 1000, 0, {lost}}}};
  CHECK(has(tasks_view(tasks, at(6000)),
            name
                + " moves unless node 'arm-1' is back within 60 s, away for "
                  "5s\n"));
  auto unsafe = sample_instance();
  unsafe.unsafe_since_unix_ms = 1000;
  unsafe.unsafe_until_unix_ms = 21'000;
  tasks.tasks[0].instances = {unsafe};
  CHECK(
      has(tasks_view(tasks, at(6000)),
          name + " waits to be stop-safe, 5s; it ends in 15s all the same\n"));
  cell_description cell;
  cell.nodes.resize(1);
  cell.nodes[0].reason = "no heartbeat for 8 s";
  cell.nodes[0].instances = {lost};
  cell.nodes[0].draining_since_unix_ms = 1;
  const auto nodes = members_view(cell, at(0));
  CHECK(has(nodes, "expected, draining"));
  CHECK(has(nodes, "no heartbeat for 8 s; " + name + " moves unless"));
}

TEST_CASE("a task that has ended shows how long it took", "[tools]") {
  const task_description tasks{
      {{"t", task_state::finished, 1000, 4000, {sample_instance()}}}};
  CHECK(has(tasks_view(tasks, at(90'000)), "TOOK"));
  CHECK(has(tasks_view(tasks, at(90'000)), " 3s\n"));
}

TEST_CASE("one instance is shown with how its earlier runs ended", "[tools]") {
  auto row = sample_instance();
  row.state = instance_state::backing_off;
  row.next_start_unix_ms = 9000;
  row.reason = "it ended with exit code 7";
  row.restarts = 3;
  row.ends = {{4000, 7, "it ended with exit code 7", "one\ntwo"}};
  const auto text = instance_view({{row}}, at(6000));
  CHECK(has(text, "next start in 3s; it ended with exit code 7\n"));
  CHECK(has(text, "started again 3 times; its last ends:\n"
                  "  2s ago: it ended with exit code 7\n"
                  "      one\n      two\n"));
}

TEST_CASE("a lost node's instance is not shown as running", "[tools]") {
  auto lost = sample_instance();
  lost.unknown_since_unix_ms = 1000;
  const task_description tasks{
      {{"t", task_state::degraded, 1000, 0, {sample_instance(), lost}}}};
  CHECK(has(tasks_view(tasks, at(6000)), "1/2, 1 unknown since 5s  arm-1\n"));
  cell_description cell;
  cell.nodes.resize(1);
  cell.nodes[0].instances = {sample_instance(), lost};
  CHECK(has(members_view(cell, at(0)), " 2 (1 unknown)  "));
  node_description node;
  node.instances = {sample_instance(), lost};
  CHECK(has(node_view(node, at(6000)), "1 running, 1 unknown\n"));
  const auto text = instances_view({{lost}}, at(6000));
  CHECK(has(text, "  unknown     5s  "));
  CHECK(has(text, "  its node is away; it was running\n"));
}

TEST_CASE("a node that has fallen silent says when it was missed", "[tools]") {
  cell_description cell;
  cell.free = {
      {"arm-1", "u", "10.0.0.2:8420", node_state::independent, "", 1000}};
  const auto text = members_view(cell, at(61'000));
  CHECK(has(text, "\narm-1  -     silent  1m00s  "));
  CHECK(has(text, "missed 1m00s ago"));
}

TEST_CASE("labels and devices of nodes are shown when all is wanted",
          "[tools]") {
  cell_description cell;
  cell.nodes.resize(1);
  cell.nodes[0].resources.labels = {{"host", "one"}, {"room", "lab"}};
  cell.nodes[0].resources.devices = {"/dev/video0"};
  auto style = at(0);
  CHECK_FALSE(has(members_view(cell, style), "LABELS"));
  style.text.tables.wide = true;
  CHECK(has(members_view(cell, style), "host=one,room=lab  /dev/video0\n"));
}

TEST_CASE("an instance's row shows what its skill tells in metrics",
          "[tools]") {
  auto row = sample_instance();
  row.status = "frames=120 dropped=3 median_us=4125";
  row.metrics = {120, 29.97, 3, 4.125};
  const auto text = instances_view({{row}}, at(2000));
  CHECK(has(text, " 120  30 Hz        3  4.12 ms "));
  CHECK_FALSE(has(text, "median_us"));
  row.metrics.rate_hz = 0;
  CHECK(has(instances_view({{row}}, at(2000)), " 0 Hz "));
}

namespace {

/// Of a skill that cannot use its images, with what goes through its streams.
instance_row barren_instance() {
  auto row = sample_instance();
  row.spec.input = {{"ros2", "/image", "sensor_msgs/msg/Image"},
                    {"ros2", "/info", "sensor_msgs/msg/CameraInfo"}};
  row.spec.output = {{"ros2", "/tf", "tf2_msgs/msg/TFMessage"}};
  row.metrics.frames = 118;
  row.metrics.remark = "118 frames in, none out: no CameraInfo has come";
  stream_count image;
  image.end = "input:0";
  image.frames = 121;
  image.rate_hz = 10;
  image.failed = 3;
  image.latency_ms = 0.25;
  stream_count info;
  info.end = "input:1";
  row.metrics.streams = {image, info};
  return row;
}

} // namespace

TEST_CASE("an instance of whose frames nothing comes says so wherever it is "
          "listed",
          "[tools]") {
  const auto row = barren_instance();
  const auto words = row.metrics.remark;
  CHECK(has(instances_view({{row}}, at(2000)), "  " + words + "\n"));
  const task_description tasks{{{"t", task_state::running, 0, 0, {row}}}};
  CHECK(has(tasks_view(tasks, at(2000)), "  poses: " + words + "\n"));
  CHECK(has(task_view(tasks, at(2000)), "  " + words + "\n"));
}

TEST_CASE("each stream's metrics are shown when all is wanted", "[tools]") {
  auto style = at(2000);
  CHECK_FALSE(has(instances_view({{barren_instance()}}, style), "/image"));
  style.text.tables.wide = true;
  CHECK(has(instances_view({{barren_instance()}}, style),
            "  in /image 10 Hz, 121 frames, 3 failed, 0.25 ms; in /info 0 "
            "frames\n"));
}

TEST_CASE("an instance's id is the first column", "[tools]") {
  // The bash completion takes it from there.
  const auto text = instances_view({{sample_instance()}}, at(2000));
  CHECK(has(text, "\nt-poses-1a2b3c4d  t     poses  arm-1  running"));
  CHECK(has(text, "apriltag3/cpu"));
}

TEST_CASE("a failed instance shows its exit code and why", "[tools]") {
  auto row = sample_instance();
  row.state = instance_state::failed;
  row.exit_code = 3;
  row.reason = "no such file";
  row.status = "reading";
  const auto text = instances_view({{row}}, at(2000));
  CHECK(has(text, "     3  no such file\n"));
}

TEST_CASE("an instance whose engine is away shows that", "[tools]") {
  auto row = sample_instance();
  row.status = "frames=12";
  row.problem = "the engine is away";
  CHECK(has(instances_view({{row}}, at(2000)), "  the engine is away\n"));
}

TEST_CASE("a skill has a row for each deployment option", "[tools]") {
  deployment_option cpu;
  cpu.name = "cpu";
  cpu.resources = {1, 96, 150, -1};
  auto gpu = cpu;
  gpu.name = "gpu";
  gpu.resources.gpu_memory_mib = 512;
  skill_row row;
  row.skill.hash = "0123456789abcdef";
  row.skill.descriptor.operation = "pose_estimation";
  row.skill.descriptor.models = {{"apriltag3", "", {cpu, gpu}}};
  row.nodes = {"b", "a"};
  const auto text = skills_view({{row}}, at(0));
  CHECK(has(text, "0123456789ab  a,b\n"));
  CHECK(has(text, "cpu           1  96 MiB  150 MiB           -"));
  CHECK(has(text, "512 MiB  0123456789ab"));
}

TEST_CASE("builds are told apart, and what is refused is shown", "[tools]") {
  skill_list list;
  for (const auto* hash : {"0123456789abcdef", "fedcba9876543210"}) {
    skill_row row;
    row.skill.hash = hash;
    row.skill.version = "1.2";
    row.skill.descriptor.operation = "see";
    row.skill.descriptor.models = {{"tag", "", {deployment_option{}}}};
    row.nodes = {"a"};
    row.added_unix_ms = {list.skills.empty() ? 1 : 2};
    list.skills.push_back(row);
  }
  list.skills[1].skill.architectures = {"arm64"};
  list.refused = {{"b", {"/skills/x/skill.json", "/entry_point/0", "gone"}}};
  const auto text = skills_view(list, at(0));
  CHECK(has(text, "see        1.2      any "));
  CHECK(has(text, "see        1.2      arm64 "));
  CHECK(has(text, "0123456789ab  a*\n"));
  CHECK(has(text, "fedcba987654  a\n"));
  CHECK(has(text, "* has a newer build"));
  CHECK(has(text, "refused on b: /skills/x/skill.json /entry_point/0: gone\n"));
}

TEST_CASE("a status shows the node, its resources and instances", "[tools]") {
  node_description node;
  node.identity = {"arm-1", "u", 1, "10.0.0.1:8420"};
  node.state = node_state::member;
  node.cell = "lab";
  node.started_unix_ms = 1000;
  node.resources = sample_resources();
  node.instances = {sample_instance()};
  const auto text = node_view(node, at(91000));
  CHECK(has(text, "name          arm-1\n"));
  CHECK(has(text, "state         member\n"));
  CHECK(has(text, "cell          lab\n"));
  CHECK(has(text, "up for        1m30s\n"));
  CHECK(has(text, "instances     1 running\n"));
  CHECK(has(text, "cpu (cores)      0.5         4       3.5\n"));
  CHECK(has(text, "t-poses-1a2b3c4d"));
  CHECK_FALSE(has(text, "coordinator"));
}

TEST_CASE("a status tells what is tried to join, and what is wrong",
          "[tools]") {
  node_description node;
  node.joining = {
      {"10.0.0.1:11811", "nothing listens there", "start it", 3, 1000}};
  const auto text = node_view(node, at(5000));
  CHECK(has(text, "joining       10.0.0.1:11811: nothing listens there (tried "
                  "3 times, last 4s ago)\n"));
  CHECK(has(text, "remedy        start it\n"));
  node.joining = {{"", "", "", 1, 1000}};
  CHECK(has(node_view(node, at(5000)),
            "joining       any cell: no answer yet (tried once, last 4s "
            "ago)\n"));
  node.joining.clear();
  CHECK_FALSE(has(node_view(node, at(5000)), "joining"));
}

TEST_CASE("a narrow terminal breaks what is wrong between words", "[tools]") {
  node_description node;
  node.joining = {{"10.0.0.1:11811", "nothing listens there, on no port at all",
                   "", 3, 1000}};
  auto style = at(5000);
  style.text.width = 60;
  const auto text = node_view(node, style);
  CHECK(has(text, "joining       10.0.0.1:11811: nothing listens there, on no\n"
                  "              port at all (tried 3 times, last 4s ago)\n"));
}

TEST_CASE("a status tells of a day's writes only after an hour", "[tools]") {
  constexpr int64_t hour_ms = 3'600'000;
  node_description node;
  node.started_unix_ms = 1000;
  CHECK_FALSE(has(node_view(node, at(hour_ms)), "disk written"));
  node.stored_bytes = 12 * 1024;
  CHECK(has(node_view(node, at(hour_ms)),
            "disk written  12 KiB since the start\n"));
  CHECK(has(node_view(node, at(1000 + hour_ms)),
            "disk written  12 KiB (288 KiB a day)\n"));
  CHECK(has(node_view(node, at(1000 + 48 * hour_ms)),
            "disk written  12 KiB (6 KiB a day)\n"));
  // A clock that was set back, and one that was never set.
  CHECK(has(node_view(node, at(0)), "12 KiB since the start\n"));
  node.started_unix_ms = 0;
  CHECK(has(node_view(node, at(hour_ms)), "12 KiB since the start\n"));
}

TEST_CASE("a status leaves unified GPU memory to the node", "[tools]") {
  node_description node;
  node.resources = sample_resources();
  node.resources.unified_memory = true;
  node.resources.gpus = {{0, "", {}}};
  CHECK(has(node_view(node, at(0)), "gpu 0 (shares memory)"));
}

TEST_CASE("a status counts the actors on request", "[tools]") {
  node_description node;
  node.actors = {{"node", 3, 0, 10, 0, 1500, 750}};
  CHECK(has(node_view(node, at(0)),
            "node    3        10        0        1.5          0.75\n"));
}

TEST_CASE("actors stand below those that spawned them", "[tools]") {
  const std::vector<actor_row> actors{{"supervisor", 3}, {"log", 4},
                                      {"runtime", 5, 3}, {"instance", 7, 3},
                                      {"packer", 8, 5},  {"left", 9, 6}};
  std::vector<std::string> names;
  std::istringstream lines{actors_view(actors, at(0))};
  for (std::string line; std::getline(lines, line);)
    names.push_back(line.substr(0, line.find("  ")));
  CHECK(names
        == std::vector<std::string>{"ACTOR", "supervisor", "├ runtime",
                                    "│ └ packer", "└ instance", "log", "left"});
}

TEST_CASE("actors that make circles, or are too many deep, are shown once",
          "[tools]") {
  std::vector<actor_row> actors{{"self", 1, 1},
                                {"late", 2, 3},
                                {"late", 3, 2},
                                {"twice", 4, 1},
                                {"twice", 4, 1}};
  for (uint64_t id = 5; id < 200; ++id)
    actors.push_back({"deep", id, id - 1});
  const auto text = actors_view(actors, at(0));
  CHECK(std::count(text.begin(), text.end(), '\n')
        == static_cast<int>(actors.size()) + 1);
}

TEST_CASE("a coordinator's status counts its cell", "[tools]") {
  cell_description cell;
  cell.nodes.resize(3);
  cell.nodes[0].state = row_state::active;
  cell.nodes[1].state = row_state::active;
  cell.nodes[2].state = row_state::lost;
  CHECK(has(cell_summary(cell, at(0)), "nodes         2 of 3 active\n"));
}
