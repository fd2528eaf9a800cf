#pragma once

#include "actors/edge/http/http_types.hpp"

#include <memory>
#include <string>

namespace roscell {

class http_connection;
struct http_shared;

/// INTERNAL to this folder: where the answer to the request in progress of a
/// connection goes, from any thread and also after the client has gone.
std::shared_ptr<reply_sink>
make_sink(std::shared_ptr<http_shared> shared,
          std::weak_ptr<http_connection> connection);

/// Status line and header fields of a reply that is not a stream.
std::string reply_head(const http_reply& reply, bool is_last);

} // namespace roscell
