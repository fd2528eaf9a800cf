#pragma once

#include "client/column.hpp"
#include "messages/cell.hpp"
#include "messages/codec/json_codec.hpp"
#include "messages/topic.hpp"

#include <string>

/// The columns in which things of one kind are listed, each described once: for
/// tables on a terminal, for `top` and for the dashboard. A list stands in
/// client/KIND_columns.cpp.
namespace roscell {

const column_list<registry_row>& node_columns();
const column_list<task_row>& task_columns();
const column_list<instance_row>& instance_columns();
const column_list<topic_row>& topic_columns();

/// What the dashboard shows of them, under the name of each kind: "nodes",
/// "tasks", "instances" and "topics". Of a column: `name`, `as` and `path` as
/// above, whether it is a `number`, and whether it is `minor`, which a narrow
/// window leaves out.
json described_columns();

/// "coordinator", and "member" for a node that has one.
std::string role_text(node_role role);

} // namespace roscell
