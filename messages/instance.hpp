#pragma once

#include "messages/codec/json_codec.hpp"
#include "messages/life.hpp"
#include "messages/resources.hpp"

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace roscell {

/// One end of a data stream.
struct io_endpoint {
  std::string protocol;  ///< "file", "ros2", "video".
  std::string endpoint;  ///< A topic name, or an absolute path on the node.
  std::string data_type; ///< "sensor_msgs/msg/Image", "image/png".
  /// Short for another step's output, "STEP" or "STEP.OUTPUT"; empty once it is
  /// written out, as the other three may be before.
  std::string from;
  bool external = false; ///< Written by a program that no task has started.

  /// An end of which only the endpoint is said.
  static io_endpoint from_text(const std::string& text) {
    return {"", text, "", "", false};
  }

  static constexpr auto fields() {
    return field_list{optional("protocol", &io_endpoint::protocol),
                      optional("endpoint", &io_endpoint::endpoint),
                      optional("data_type", &io_endpoint::data_type),
                      optional("from", &io_endpoint::from),
                      optional("external", &io_endpoint::external)};
  }
};

/// Everything a node must know to run one instance.
struct instance_spec {
  std::string instance; ///< Unique: "<task>-<step>-<8 hex digits>".
  std::string task;
  std::string step;
  std::string operation;
  std::string model;
  std::string deployment;
  std::string skill; ///< Content hash of the skill folder.
  std::string cell;
  int gpu = -1; ///< Negative: none.
  std::vector<io_endpoint> input;
  std::vector<io_endpoint> output;
  std::string
      parameters; ///< JSON object: the model's, overridden by the step's.
  std::map<std::string, std::string> environment;
  resource_request resources;
  life_policy life;
  std::vector<std::string> arguments; ///< The step's, after the skill's.
  std::vector<std::string> secrets;   ///< Of its node, given to it as files.
  /// Environment variables, each with the name of the secret that is its value.
  std::map<std::string, std::string> secret_env;

  static constexpr auto fields() {
    return field_list{required("instance", &instance_spec::instance),
                      required("task", &instance_spec::task),
                      required("step", &instance_spec::step),
                      required("operation", &instance_spec::operation),
                      required("model", &instance_spec::model),
                      required("deployment", &instance_spec::deployment),
                      required("skill", &instance_spec::skill),
                      required("cell", &instance_spec::cell),
                      nullable("gpu", &instance_spec::gpu),
                      one_or_many("input", &instance_spec::input),
                      one_or_many("output", &instance_spec::output),
                      raw_json("parameters", &instance_spec::parameters),
                      optional("environment", &instance_spec::environment),
                      required("resources", &instance_spec::resources),
                      optional("life", &instance_spec::life),
                      optional("arguments", &instance_spec::arguments),
                      optional("secrets", &instance_spec::secrets),
                      optional("secret_env", &instance_spec::secret_env)};
  }
};

/// Life of an instance; the diagram is in docs/protocols.md.
enum class instance_state {
  pending,
  building,
  starting,
  running,
  backing_off, ///< It has ended and is to be started again.
  stopping,
  stopped,
  failed,
};

constexpr auto enum_words(instance_state) {
  return std::array<std::string_view, 8>{"pending", "building",    "starting",
                                         "running", "backing_off", "stopping",
                                         "stopped", "failed"};
}

/// True until the instance has ended: it holds its resources.
constexpr bool is_live(instance_state state) {
  return state < instance_state::stopped;
}

/// Upper bounds of the times by which a skill counts its frames.
constexpr std::array<double, 10> latency_bounds_ms{1,  2,   5,   10,  20,
                                                   50, 100, 200, 500, 1000};

/// What has gone through one end of a data stream of an instance since it was
/// started, as its skill has counted it. Negative: not known.
struct stream_count {
  std::string end;        ///< As in `stream_metrics`.
  int64_t frames = 0;     ///< That have come in, or gone out.
  int64_t processed = -1; ///< Of an input: those, without what failed.
  int64_t failed = 0;     ///< Of an input.
  int64_t dropped = 0;    ///< Of an input: they came too fast.
  double latency_ms = -1; ///< Of an input: median time to process one.
  double rate_hz = -1;    ///< Of `frames`, between the last two words.
  double quiet_s = -1;    ///< For so long there has been no frame.
  /// For so long there have been three frames in each ten seconds, or more.
  double steady_s = -1;

  static constexpr auto fields() {
    return field_list{required("end", &stream_count::end),
                      required("frames", &stream_count::frames),
                      optional("processed", &stream_count::processed),
                      optional("failed", &stream_count::failed),
                      optional("dropped", &stream_count::dropped),
                      optional("latency_ms", &stream_count::latency_ms),
                      optional("rate_hz", &stream_count::rate_hz),
                      optional("quiet_s", &stream_count::quiet_s),
                      optional("steady_s", &stream_count::steady_s)};
  }
};

/// What an instance takes of its host, as its node has read it when it was
/// asked. Negative: not known.
struct instance_use {
  double memory_mib = -1; ///< Without what the kernel can take back.
  double memory_limit_mib =
      -1;                   ///< That the kernel holds it to; none: no bound.
  double cpu = -1;          ///< Cores, since it was asked before.
  double cpu_s = -1;        ///< Time of a core since its program started.
  int64_t memory_kills = 0; ///< Processes of it that were ended for memory.
  int64_t pid = 0; ///< Of its program, as its host counts; 0: not known.

  static constexpr auto fields() {
    return field_list{
        optional("memory_mib", &instance_use::memory_mib),
        optional("memory_limit_mib", &instance_use::memory_limit_mib),
        optional("cpu", &instance_use::cpu),
        optional("cpu_s", &instance_use::cpu_s),
        optional("memory_kills", &instance_use::memory_kills),
        optional("pid", &instance_use::pid)};
  }
};

/// What an instance has done, as its skill tells in its status. Negative: not
/// known. Where a skill has several inputs, frames and their times are those of
/// the input that it works on.
struct instance_metrics {
  int64_t frames = -1;    ///< Processed since it was started.
  double rate_hz = -1;    ///< Frames a second between its last two words.
  int64_t dropped = -1;   ///< Frames that came too fast for it.
  double latency_ms = -1; ///< Median time to process a frame.
  /// How many frames took how long since the start: one count for each of
  /// `latency_bounds_ms`, and one for those beyond. Empty: not known.
  std::vector<int64_t> latency_counts;
  double latency_sum_ms = -1; ///< Of all frames.
  /// Median time from the stamp of a frame, which its sensor gave it, to the
  /// output of what came of it; by the clocks of both hosts.
  double age_ms = -1;
  std::vector<stream_count> streams; ///< Inputs before outputs.
  std::string remark; ///< Why nothing comes of its frames; empty: it does.
  instance_use use;   ///< What its node has read, not its skill.

  static constexpr auto fields() {
    return field_list{
        optional("frames", &instance_metrics::frames),
        optional("rate_hz", &instance_metrics::rate_hz),
        optional("dropped", &instance_metrics::dropped),
        optional("latency_ms", &instance_metrics::latency_ms),
        optional("latency_counts", &instance_metrics::latency_counts),
        optional("latency_sum_ms", &instance_metrics::latency_sum_ms),
        optional("age_ms", &instance_metrics::age_ms),
        optional("streams", &instance_metrics::streams),
        optional("remark", &instance_metrics::remark),
        optional("use", &instance_metrics::use)};
  }
};

/// What is known of one instance.
struct instance_row {
  instance_spec spec;
  std::string node;
  instance_state state = instance_state::pending;
  int64_t since_unix_ms = 0; ///< When `state` was entered.
  /// The skill's own last STATUS line; while `building`, the step of the build.
  std::string status;
  /// Why the engine under it cannot be asked at present; empty: it can.
  std::string problem;
  std::string container; ///< The runtime's id of it.
  std::string image;
  /// Exit code of an ended instance; 128 + n after signal n; negative: none.
  int exit_code = -1;
  std::string reason;   ///< Why it failed or stopped, one sentence.
  std::string log_tail; ///< Last lines of the log of a failed instance.
  /// Since when it is unknown whether `state` still holds, because the node is
  /// away; 0: it is known.
  int64_t unknown_since_unix_ms = 0;
  instance_metrics metrics; ///< As of when its node was asked last.
  int64_t restarts = 0;     ///< How often its node has started it again,
  int64_t attempts = 0;     ///< and that without running for long.
  /// When it is started again while it is `backing_off`; 0: once its node is
  /// back in its cell.
  int64_t next_start_unix_ms = 0;
  std::vector<ended_run> ends; ///< The last ones, the newest first.
  instance_health health = instance_health::good;
  std::string health_reason; ///< The value and what should feed it.
  safe_word safe = safe_word::untold;
  /// Since when it is to end and is waited for to be stop-safe; 0: it is not.
  int64_t unsafe_since_unix_ms = 0;
  int64_t unsafe_until_unix_ms = 0; ///< It is ended then; 0: never.
  std::string waits; ///< For what it waits, one sentence; empty: for nothing.
  /// When it was found that its host had interrupted it; 0: it runs again, or
  /// never was.
  int64_t interrupted_unix_ms = 0;
  bool out_of_memory = false; ///< That is why its last run has ended.

  static constexpr auto fields() {
    return field_list{
        required("spec", &instance_row::spec),
        required("node", &instance_row::node),
        required("state", &instance_row::state),
        required("since_unix_ms", &instance_row::since_unix_ms),
        optional("status", &instance_row::status),
        optional("trouble", &instance_row::problem),
        optional("container", &instance_row::container),
        optional("image", &instance_row::image),
        nullable("exit_code", &instance_row::exit_code),
        optional("reason", &instance_row::reason),
        optional("log_tail", &instance_row::log_tail),
        optional("unknown_since_unix_ms", &instance_row::unknown_since_unix_ms),
        optional("figures", &instance_row::metrics),
        optional("restarts", &instance_row::restarts),
        optional("attempts", &instance_row::attempts),
        optional("next_start_unix_ms", &instance_row::next_start_unix_ms),
        optional("ends", &instance_row::ends),
        optional("health", &instance_row::health),
        optional("health_reason", &instance_row::health_reason),
        optional("safe", &instance_row::safe),
        optional("unsafe_since_unix_ms", &instance_row::unsafe_since_unix_ms),
        optional("unsafe_until_unix_ms", &instance_row::unsafe_until_unix_ms),
        optional("waits", &instance_row::waits),
        optional("interrupted_unix_ms", &instance_row::interrupted_unix_ms),
        optional("out_of_memory", &instance_row::out_of_memory)};
  }
};

struct instance_query {
  static constexpr const char* type = "instance_query";
  std::string instance; ///< Empty: all.
  std::string task;     ///< Empty: of every task.

  static constexpr auto fields() {
    return field_list{optional("instance", &instance_query::instance),
                      optional("task", &instance_query::task)};
  }
};

struct instance_description {
  static constexpr const char* type = "instance_description";
  std::vector<instance_row> instances;

  static constexpr auto fields() {
    return field_list{required("instances", &instance_description::instances)};
  }
};

/// Asks for a part of an instance's log. The answer waits up to `wait_ms` for
/// something to be there, which is how a log is followed without polling.
struct log_query {
  static constexpr const char* type = "log_query";
  std::string instance;
  int64_t offset = -1;    ///< Where to begin; negative: the last lines.
  int64_t tail_lines = 0; ///< With a negative offset: how many; 0: the default.
  int64_t wait_ms = 0;    ///< At most 20,000.
  bool times = false;     ///< Also tell when each line was logged.
  /// The log that was kept of an earlier run, even where one of that id is
  /// there now. Without it a kept log is read where there is no other.
  bool previous = false;
  std::string node; ///< Whose kept log; empty: the newest one of the cell.

  static constexpr auto fields() {
    return field_list{required("instance", &log_query::instance),
                      optional("offset", &log_query::offset),
                      optional("tail_lines", &log_query::tail_lines),
                      optional("wait_ms", &log_query::wait_ms),
                      optional("times", &log_query::times),
                      optional("previous", &log_query::previous),
                      optional("node", &log_query::node)};
  }
};

/// A part of a log. An offset is a place in all that was ever logged, so it
/// stays valid when old text is dropped: the process runtime counts bytes, the
/// engine runtime time. 0 is the beginning; other places come from
/// `next_offset`.
struct log_excerpt {
  static constexpr const char* type = "log_excerpt";
  std::string instance;
  std::string text;        ///< Valid UTF-8; other bytes are replaced.
  int64_t next_offset = 0; ///< Where the next query goes on.
  bool ended = false;      ///< Nothing will follow after `next_offset`.
  /// If it was asked for: when each line of `text` was logged, or the rest of
  /// one that began before it; 0: not known.
  std::vector<int64_t> times_unix_ms;
  /// Where `text` is not what was logged byte by byte: that, in base64.
  std::string bytes;

  static constexpr auto fields() {
    return field_list{required("instance", &log_excerpt::instance),
                      required("text", &log_excerpt::text),
                      required("next_offset", &log_excerpt::next_offset),
                      required("ended", &log_excerpt::ended),
                      optional("times_unix_ms", &log_excerpt::times_unix_ms),
                      optional("bytes", &log_excerpt::bytes)};
  }
};

} // namespace roscell
