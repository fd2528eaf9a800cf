// The one place where Asio and Beast are compiled; everywhere else the
// definitions of target boost_beast leave declarations only.
#include <boost/asio/impl/src.hpp>

#include <boost/beast/src.hpp>
